"""Measures of results written as text: ``max(RM3@hub)``, ``last(RF2@tip) / last(U2@tip)``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ast
import operator
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.mesh.geometric import is_selection
from corota.results.reduction import is_summed

if TYPE_CHECKING:
    from collections.abc import Callable

    from corota.arrays import Floats
    from corota.results.results import Results


#: Reducers of a history to one number.
REDUCERS: dict[str, Callable[[Floats], float]] = {
    "last": lambda values: float(values[-1]),
    "first": lambda values: float(values[0]),
    "max": lambda values: float(np.nanmax(values)),
    "min": lambda values: float(np.nanmin(values)),
    "absmax": lambda values: float(np.nanmax(np.abs(values))),
    "mean": lambda values: float(np.nanmean(values)),
}
#: How each combines the values of one increment by default.
COMBINED = {"max": "max", "min": "min"}
_OPERATORS: dict[type[ast.AST], Callable[..., float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}


class Measure:
    """A number of results, given as text.

    Parameters
    ----------
    text : str
        ``REDUCER(VARIABLE@PLACE)`` with ``last``, ``first``, ``max``, ``min``, ``absmax`` or
        ``mean``; a variable as in :meth:`Results.history`; a place is a set, a selection such as
        ``near(10, 0.5)``, or a node number, and may be omitted; ``nodes`` takes the nodal values
        of stress and strain. Names may have blanks, ``max(load factor)``; others that are not
        identifiers are quoted. Without a place ``max`` and ``min`` are the largest and smallest
        value anywhere at any time, the others take the value of the largest size of each increment.
        A history without a reducer is its last value. ``+ - * / **`` and ``abs`` combine measures.

    Raises
    ------
    InputError
        If the text is not such an expression.

    Examples
    --------
    >>> from corota.sweeps.measures import Measure
    >>> Measure("max(RF2@tip) / 2").text
    'max(RF2@tip) / 2'
    """

    def __init__(self, text: str) -> None:
        self.text = text.strip()
        try:
            self._tree = ast.parse(_quoted(self.text), mode="eval").body
        except (SyntaxError, RecursionError, MemoryError, ValueError):
            raise self._fault() from None
        self._check(self._tree)

    def __call__(self, results: Results) -> float:
        """Value for results."""
        return float(self._value(self._tree, results))

    def _fault(self, why: str = "") -> InputError:
        return InputError(
            f"measure {self.text!r}: {why or 'no expression'}; write REDUCER(VARIABLE@SET), such "
            f"as max(RM3@hub); reducers are {', '.join(REDUCERS)}"
        )

    def _check(self, node: ast.AST) -> None:
        if isinstance(node, ast.Call):
            name = node.func.id if isinstance(node.func, ast.Name) else ""
            if name not in REDUCERS and name != "abs":
                raise self._fault(f"no reducer {name!r}")
            if len(node.args) != 1 or node.keywords:
                raise self._fault(f"{name} takes one history")
            if name == "abs":
                self._check(node.args[0])
            elif _history(node.args[0]) is None:
                raise self._fault(f"{name} takes a variable, or a variable and a place")
        elif isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            self._check(node.left)
            self._check(node.right)
        elif isinstance(node, ast.UnaryOp) and type(node.op) in _OPERATORS:
            self._check(node.operand)
        elif not (
            _history(node) is not None
            or (isinstance(node, ast.Constant) and isinstance(node.value, (int, float)))
        ):
            raise self._fault()

    def _value(self, node: ast.AST, results: Results) -> float:
        if isinstance(node, ast.Call):
            name = node.func.id if isinstance(node.func, ast.Name) else ""
            if name == "abs":
                return abs(self._value(node.args[0], results))
            return REDUCERS[name](self._series(node.args[0], results, COMBINED.get(name, "auto")))
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            a, b = self._value(node.left, results), self._value(node.right, results)
            try:
                return _OPERATORS[type(node.op)](a, b)
            except (ArithmeticError, ValueError) as error:
                raise InputError(f"measure {self.text!r}: {error}") from None
        if isinstance(node, ast.UnaryOp):
            return _OPERATORS[type(node.op)](self._value(node.operand, results))
        if isinstance(node, ast.Constant) and not isinstance(node.value, str):
            return float(node.value)  # type: ignore[arg-type]
        return float(self._series(node, results, "auto")[-1])

    def _series(self, node: ast.AST, results: Results, combine: Any) -> Floats:
        found = _history(node)
        assert found is not None
        name, place = found
        at: Any = place or None
        if place.isdigit() and place not in results.mesh.node_sets:
            at = np.flatnonzero(results.mesh.node_labels == int(place))
            if not len(at):
                raise InputError(f"measure {self.text!r}: there is no node {place}")
        if name.upper() == "RM3" and at is not None:
            return total_moment(results, at)
        everywhere = at is None or at == "nodes"
        combine = combine if everywhere and not is_summed(name) else "auto"
        return np.asarray(results.history(name, at=at, combine=combine), dtype=float)


def _quoted(text: str) -> str:
    """An expression with quotes around names of several words.

    Examples
    --------
    >>> _quoted("max(load factor) / last(MISES)"), _quoted("last('a b@c')")
    ("max('load factor') / last(MISES)", "last('a b@c')")
    >>> _quoted("last(hub: snap load)")
    "last('hub: snap load')"
    """
    words = r"""("[^"]*"|'[^']*')|([A-Za-z_]\w*(?::?[ \t]+\w+)+)"""
    return re.sub(words, lambda m: m[1] or repr(" ".join(m[2].split())), text)


def total_moment(results: Results, at: Any) -> Floats:
    """Total moment of the reactions of a place in each frame, as in the CSV file."""
    from corota.io.tables.csv_history import Histories

    histories = Histories(results.model, results.model.steps)
    nodes = results.mesh.node_indices(at)
    return np.array([histories.moment(frame, nodes)[1] for frame in results.frames])


def _history(node: ast.AST) -> tuple[str, str] | None:
    """Variable and place of ``NAME`` or ``NAME@PLACE``; nothing for other expressions."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
        name = _word(node.left)
        place = _word(node.right) or _number(node.right) or _selection(node.right)
        return (name, place) if name and place else None
    name = _word(node)
    return (name, "") if name else None


def _word(node: ast.AST) -> str:
    if isinstance(node, ast.Name):
        return node.id
    text = node.value if isinstance(node, ast.Constant) else ""
    return text if isinstance(text, str) else ""


def _selection(node: ast.AST) -> str:
    """Name of a selection by geometry, such as ``near(10, 0.5)``."""
    text = ast.unparse(node) if isinstance(node, ast.Call) else ""
    return text if is_selection(text) else ""


def _number(node: ast.AST) -> str:
    value = node.value if isinstance(node, ast.Constant) else None
    return str(value) if type(value) is int else ""
