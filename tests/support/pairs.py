"""Few cases out of a product of lists, with all pairs of their values."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections import Counter
from itertools import combinations, product
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Collection


def cover(
    *lists: Collection[Any], strength: int = 2, allowed: Callable[..., bool] | None = None
) -> list[Any]:
    """Cases in which every combination of `strength` values of different lists occurs.

    An error that shows with one element and one law, say, shows in some case, whatever the third
    list does. Each case is the one that has most combinations no case before it has (R. C. Bryce
    and C. J. Colbourn, Information and Software Technology 48 (2006) 960-970), of these the first
    with the least used values: the same lists give the same cases.

    Parameters
    ----------
    *lists
        Values of each parameter.
    strength : int
        1: every value occurs, and the other cases are marked slow; 2: every pair of values does,
        and there are no other cases.
    allowed : callable, optional
        Whether a case exists, given its values.

    Returns
    -------
    list of tuple or ParameterSet
        One value of each list, for `parametrize`.
    """
    left = [
        (case, numbers, frozenset(combinations(numbers, strength)))
        for case, places in zip(
            product(*lists), product(*(range(len(values)) for values in lists)), strict=True
        )
        if allowed is None or allowed(*case)
        for numbers in [tuple(enumerate(places))]
    ]
    missing = set().union(*(parts for _, _, parts in left))
    used: Counter[tuple[int, int]] = Counter()
    cases = []
    while missing:
        case, numbers, parts = max(
            left, key=lambda one: (len(one[2] & missing), -sum(used[n] for n in one[1]))
        )
        missing -= parts
        used.update(numbers)
        cases.append(case)
    if strength > 1:
        return cases
    return cases + [
        pytest.param(*case, marks=pytest.mark.slow) for case, _, _ in left if case not in cases
    ]


def quickly(values: Collection[Any], *quick: Any) -> list[Any]:
    """Values for `parametrize`, those not in `quick` marked slow: where one case takes a second.

    A tuple gives the values of several parameters.
    """
    return [
        v
        if v in quick
        else pytest.param(*(v if isinstance(v, tuple) else (v,)), marks=pytest.mark.slow)
        for v in values
    ]
