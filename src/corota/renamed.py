"""Keywords that had another name: accepted, with a note that gives the new one."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import Any, TypeVar, cast

F = TypeVar("F", bound="Callable[..., Any]")


def accept_old_names(**names: str) -> Callable[[F], F]:
    """Make a decorator of a function or class whose keywords were renamed.

    Parameters
    ----------
    **names
        Old name = new name.

    Returns
    -------
    callable
        The decorator. A call with an old name works as with the new one and warns
        (:class:`DeprecationWarning`).

    Examples
    --------
    >>> @accept_old_names(centre="center")
    ... def circle(radius, center=0.0):
    ...     return center
    >>> circle(1.0, center=2.0)
    2.0
    """

    def decorate(target: F) -> F:
        if isinstance(target, type):
            kind: Any = target
            kind.__init__ = decorate(kind.__init__)
            return target

        @functools.wraps(target)
        def call(*args: Any, **kwargs: Any) -> Any:
            for old, new in names.items():
                if old in kwargs:
                    warnings.warn(
                        f"{target.__qualname__}: the keyword {old} is now called {new}",
                        DeprecationWarning,
                        stacklevel=2,
                    )
                    kwargs.setdefault(new, kwargs.pop(old))
            return target(*args, **kwargs)

        return cast("F", call)

    return decorate
