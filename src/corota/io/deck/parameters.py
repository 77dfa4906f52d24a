"""``*PARAMETER``: named numbers of a deck, evaluated and substituted for ``<name>``."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping

Value = int | float | str

_CARD = re.compile(rb"^[ \t]*\*[ \t]*parameter\b", re.IGNORECASE | re.MULTILINE)
_USE = re.compile(r"<([^<>,*\n]{1,80})>")
_MATHEMATICS = [
    "sqrt",
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "exp",
    "log",
    "log10",
    "sinh",
    "cosh",
    "tanh",
    "radians",
    "degrees",
    "floor",
    "ceil",
]
_FUNCTIONS: dict[str, Callable[..., float]] = {
    **{name: getattr(math, name) for name in _MATHEMATICS},
    **{"abs": abs, "min": min, "max": max, "int": int, "float": float, "round": round, "pow": pow},
}
_OPERATORS: dict[type[ast.AST], Callable[..., Value]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}
#: Depth of an expression, and digits of a number.
_DEPTH, _LARGEST = 50, 1e300
#: Bytes of a text that may hold nothing but a mesh.
_LONG = 1 << 20


class Parameters:
    """The parameters that a deck has given so far.

    Parameters
    ----------
    given : mapping of str to number, optional
        Values that replace those of the deck.
    """

    def __init__(self, given: Mapping[str, Value] | None = None) -> None:
        self.values: dict[str, Value] = {"pi": math.pi}
        self._given = {name.lower(): (name, value) for name, value in (given or {}).items()}
        self._used: set[str] = set()

    def unused(self) -> list[str]:
        """Given names that the deck does not have."""
        return [name for key, (name, _) in self._given.items() if key not in self._used]

    def applied(
        self, data: bytes, decode: Callable[[bytes], str]
    ) -> tuple[bytes, list[tuple[int, str]]]:
        """Text with ``<name>`` replaced, and faults with their line numbers (from 1).

        Lines keep their numbers. Data without parameters come back as they are.
        """
        used = b"<" in data
        # A long text without any use is not searched: reading meshes stays fast.
        given = (used or len(data) < _LONG) and _CARD.search(data) is not None
        if not given and not (used and len(self.values) > 1):
            return data, []
        lines = decode(data).split("\n")
        faults: list[tuple[int, str]] = []
        inside = False
        for number, line in enumerate(lines, 1):
            stripped = line.strip()
            if stripped.startswith("**"):
                continue
            if stripped.startswith("*"):
                inside = _CARD.match(stripped.encode()) is not None
            elif inside and stripped:
                try:
                    self._assign(stripped)
                except OverflowError:
                    faults.append((number, "the number is too large"))
                except (ValueError, ArithmeticError, TypeError) as error:
                    faults.append((number, str(error)))
                continue
            if "<" in line:
                lines[number - 1], unknown = self._replaced(line)
                faults += [(number, _unknown(name)) for name in unknown]
        return "\n".join(lines).encode(), faults

    def _replaced(self, line: str) -> tuple[str, list[str]]:
        unknown: list[str] = []

        def value(match: re.Match[str]) -> str:
            name = match.group(1).strip()
            if name.lower() not in self.values:
                unknown.append(name)
                return match.group(0)
            found = self.values[name.lower()]
            return found if isinstance(found, str) else repr(found)

        return _USE.sub(value, line), unknown

    def _assign(self, line: str) -> None:
        name, equals, text = line.partition("=")
        name = name.strip()
        if not equals or not name.isidentifier():
            raise ValueError(f"expected name = expression, found {line[:60]!r}")
        key = name.lower()
        if key in self._given:
            self._used.add(key)
            self.values[key] = _limited(self._given[key][1])
            return
        text = text.split("#")[0].strip()
        try:
            tree = ast.parse(text, mode="eval")
        except (SyntaxError, RecursionError, MemoryError):
            raise ValueError(f"{name}: {text[:60]!r} is not an expression") from None
        self.values[key] = self._value(tree.body, 0)

    def _value(self, node: ast.AST, depth: int) -> Value:
        """Value of an expression of numbers, names, + - * / ** and functions of mathematics."""
        if depth > _DEPTH:
            raise ValueError("the expression is too deep")
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float, str)):
            return _limited(node.value)
        if isinstance(node, ast.Name):
            if node.id.lower() not in self.values:
                raise ValueError(f"no *PARAMETER named {node.id} before this")
            return self.values[node.id.lower()]
        if isinstance(node, ast.UnaryOp) and type(node.op) in _OPERATORS:
            return _limited(_OPERATORS[type(node.op)](self._value(node.operand, depth + 1)))
        if isinstance(node, ast.BinOp):
            a, b = self._value(node.left, depth + 1), self._value(node.right, depth + 1)
            texts = isinstance(a, str) + isinstance(b, str)
            if texts and not (texts == 2 and isinstance(node.op, ast.Add)):
                raise ValueError("strings and numbers cannot be mixed")
            if isinstance(node.op, ast.Pow):
                return _limited(_power(a, b))
            if type(node.op) in _OPERATORS:
                return _limited(_OPERATORS[type(node.op)](a, b))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
            function = _FUNCTIONS.get(node.func.id.lower())
            if function is None:
                known = ", ".join(_FUNCTIONS)
                raise ValueError(f"no function {node.func.id}; there are {known}")
            found = [self._value(argument, depth + 1) for argument in node.args]
            if node.func.id.lower() == "pow" and len(found) == 2:
                return _limited(_power(*found))
            return _limited(function(*found))
        raise ValueError("only numbers, names, + - * / ** and functions may stand here")


def _unknown(name: str) -> str:
    if name.isidentifier():
        return f"no *PARAMETER named {name} before this"
    return f"<{name}>: expressions belong below *PARAMETER (t2 = {name}), and <t2> here"


def _power(a: Value, b: Value) -> Value:
    if isinstance(a, str) or isinstance(b, str):
        raise ValueError("a string cannot be raised to a power")
    small = isinstance(a, int) and isinstance(b, int) and 0 <= b <= 30 and abs(a) < 1000
    found = a**b if small else float(a) ** float(b)
    if isinstance(found, complex):
        raise ValueError("a root of a negative number")
    return found


def _limited(value: Value) -> Value:
    if isinstance(value, str):
        if len(value) > 200:
            raise ValueError("a string is longer than 200 characters")
    elif not abs(value) < _LARGEST:
        raise ValueError("the number is too large")
    return value
