"""Designs of experiments: parameter values of a sweep."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from corota.errors import InputError
from corota.names import choose

#: Classes of ``scipy.stats.qmc`` by the names that `sample` takes.
ENGINES = {"sobol": "Sobol", "halton": "Halton", "latin": "LatinHypercube"}

Row = dict[str, Any]
#: Rows that a design may have; more would fill the memory before the first one runs.
MOST_ROWS = 1_000_000


def grid(**values: Sequence[Any]) -> list[Row]:
    """All combinations of values; the last parameter varies fastest.

    Examples
    --------
    >>> import corota as ct
    >>> ct.grid(thickness=[0.2, 0.3], angle=[30])
    [{'thickness': 0.2, 'angle': 30}, {'thickness': 0.3, 'angle': 30}]
    """
    count = math.prod(len(given) for given in values.values())
    if count > MOST_ROWS:
        raise InputError(f"a sweep has at most {MOST_ROWS:,} rows, not {count:,}: use a sample")
    return [dict(zip(values, found, strict=True)) for found in itertools.product(*values.values())]


def sample(
    n: int, ranges: Mapping[str, Sequence[float]], *, engine: str = "latin", seed: int = 0
) -> list[Row]:
    """Quasi-random points in a box, by ``scipy.stats.qmc``.

    Parameters
    ----------
    n : int
        Number of points; a power of two for ``"sobol"``.
    ranges : mapping of str to pair of float
        Lower and upper bound of each parameter.
    engine : {"latin", "sobol", "halton"}
        Latin hypercube, Sobol or Halton points, scrambled.
    seed : int
        The same seed gives the same points.

    Examples
    --------
    >>> import corota as ct
    >>> rows = ct.sample(4, {"thickness": (0.2, 0.6), "length": (10.0, 20.0)})
    >>> len(rows), all(0.2 <= row["thickness"] <= 0.6 for row in rows)
    (4, True)
    """
    engine = choose(engine, tuple(ENGINES), "engine of a sample")
    if n < 1 or not ranges:
        raise InputError("a sample needs at least one point and one parameter with its bounds")
    for name, bounds in ranges.items():
        if len(bounds) != 2 or not bounds[0] < bounds[1]:
            raise InputError(f"{name}: give a lower and a larger upper bound, not {bounds!r}")
    from scipy.stats import qmc

    points = getattr(qmc, ENGINES[engine])(len(ranges), seed=seed).random(n)
    low, high = zip(*ranges.values(), strict=True)
    return [dict(zip(ranges, map(float, p), strict=True)) for p in qmc.scale(points, low, high)]


def rows_of(
    parameters: Mapping[str, Sequence[Any]] | Iterable[Mapping[str, Any]] | Any,
) -> list[Row]:
    """Rows of a design: a grid of named values, a list of mappings, or a pandas data frame.

    Raises
    ------
    InputError
        If there are none, or their names differ.
    """
    if hasattr(parameters, "to_dict") and hasattr(parameters, "columns"):
        rows = [dict(row) for row in parameters.to_dict("records")]
    elif isinstance(parameters, Mapping):
        for name, values in parameters.items():
            if isinstance(values, str) or not hasattr(values, "__len__"):
                raise InputError(f"parameter {name!r}: give a list of values, not {values!r}")
        rows = grid(**{str(name): list(values) for name, values in parameters.items()})
    else:
        rows = [dict(row) for row in parameters]
    rows = [{str(k): plain(v) for k, v in row.items()} for row in rows]
    if not rows or not rows[0]:
        raise InputError("the sweep has no rows: each parameter needs at least one value")
    for number, row in enumerate(rows):
        if set(row) != set(rows[0]):
            names, first = sorted(row), sorted(rows[0])
            raise InputError(f"row {number} of the sweep has the parameters {names}, row 0 {first}")
    return rows


def plain(value: Any) -> Any:
    """A NumPy number as one of Python."""
    return value.item() if hasattr(value, "item") and getattr(value, "ndim", 1) == 0 else value
