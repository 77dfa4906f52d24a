"""Lazy references to functions in tables, without loading their modules."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from sys import modules
from typing import Any


def lazy(place: str) -> Callable[..., Any]:
    """Proxy of a function whose module is imported at the first call.

    Parameters
    ----------
    place : str
        ``"package.module:function"``.

    Examples
    --------
    >>> root = lazy("math:sqrt")
    >>> root(9.0)
    3.0
    """
    module, _, name = place.partition(":")

    def call(*args: Any, **options: Any) -> Any:
        found = getattr(modules.get(module), name, None) or getattr(import_module(module), name)
        return found(*args, **options)

    call.__module__, call.__name__, call.__qualname__ = module, name, name
    return call
