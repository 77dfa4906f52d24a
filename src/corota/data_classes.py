"""Data classes whose ``__init__`` is compiled at its first use, not at import.

The standard library compiles the text of each method while a module is imported, .1 ms a method.
Most classes are imported and never used in the same run. Here the fields come from the standard
library as well, so ``fields``, ``replace`` and ``asdict`` work as usual.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import dataclasses
from dataclasses import MISSING, FrozenInstanceError, fields
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable


def _dataclass(
    kind: type | None = None,
    /,
    *,
    repr: bool = True,
    eq: bool = True,
    frozen: bool = False,
    slots: bool = False,
    kw_only: bool = False,
) -> Any:
    """Make a data class; the options are those of :func:`dataclasses.dataclass`."""

    def decorate(kind: type) -> Any:
        types, bare = kind.__annotations__, {}
        for name, text in types.items():
            if "ClassVar" not in text:
                bare[name] = object  # the standard library searches in each text
        kind.__annotations__ = bare
        layout: dict[str, bool] = {"slots": slots, "kw_only": kw_only}
        made: Any = dataclasses.dataclass(init=False, repr=False, eq=False, **layout)(kind)
        made.__annotations__ = types
        for name in bare:
            made.__dataclass_fields__[name].type = types[name]
        own = vars(made)
        if "__init__" not in own:
            made.__init__ = _Init(made, frozen)
        if repr and "__repr__" not in own:
            made.__repr__ = _repr(made)
        if eq and "__eq__" not in own:
            made.__eq__ = _eq(made)
        if eq and own.get("__hash__") is None:
            made.__hash__ = _hash(made) if frozen else None
        if frozen:
            made.__setattr__, made.__delattr__ = _refusal("assign to"), _refusal("delete")
        return made

    return decorate if kind is None else decorate(kind)


class _Init:
    """Stands for ``__init__`` of a class until something looks it up."""

    def __init__(self, kind: Any, frozen: bool) -> None:
        self.kind, self.frozen = kind, frozen

    def __get__(self, instance: Any, owner: type | None = None) -> Any:
        self.kind.__init__ = _compiled_init(self.kind, self.frozen)
        return self.kind.__init__.__get__(instance, owner)


class _Absent:
    """Default of an argument whose value is made for each object."""

    def __repr__(self) -> str:
        return "<factory>"


def _compiled_init(kind: Any, frozen: bool) -> Callable[..., None]:
    """Compile ``__init__``: arguments in the order of the fields, then ``__post_init__``."""
    names: dict[str, Any] = {"_set": object.__setattr__, "_absent": _Absent()}
    places: list[str] = ["self"]
    keywords: list[str] = ["*"]
    lines = []
    for item in fields(kind):
        name, value = item.name, item.name
        arguments = keywords if item.kw_only is True else places
        if item.default_factory is not MISSING:
            names[f"_make_{name}"] = item.default_factory
            value = f"_make_{name}()"
            if item.init:
                arguments.append(f"{name}=_absent")
                value = f"{value} if {name} is _absent else {name}"
        elif not item.init:
            continue  # the class has the default
        elif item.default is not MISSING:
            names[f"_default_{name}"] = item.default
            arguments.append(f"{name}=_default_{name}")
        else:
            arguments.append(name)
        lines.append(f"_set(self, {name!r}, {value})" if frozen else f"self.{name} = {value}")
    if hasattr(kind, "__post_init__"):
        lines.append("self.__post_init__()")
    arguments = places if keywords == ["*"] else [*places, *keywords]
    head = f"def __init__({', '.join(arguments)}):"
    exec("\n    ".join([head, *(lines or ["pass"])]), names)
    init: Callable[..., None] = names["__init__"]
    init.__module__, init.__qualname__ = kind.__module__, f"{kind.__qualname__}.__init__"
    init.__annotations__ = {item.name: item.type for item in fields(kind) if item.init}
    init.__annotations__["return"] = None
    return init


def _repr(kind: Any) -> Callable[[Any], str]:
    @recursive_repr()
    def __repr__(self: Any) -> str:
        shown = [f"{f.name}={getattr(self, f.name)!r}" for f in fields(kind) if f.repr]
        return f"{type(self).__qualname__}({', '.join(shown)})"

    return __repr__


def _compared(kind: Any, instance: Any) -> tuple[Any, ...]:
    return tuple(getattr(instance, item.name) for item in fields(kind) if item.compare)


def _eq(kind: Any) -> Callable[[Any, object], Any]:
    def __eq__(self: Any, other: object) -> Any:
        if type(other) is not type(self):
            return NotImplemented
        return _compared(kind, self) == _compared(kind, other)

    return __eq__


def _hash(kind: Any) -> Callable[[Any], int]:
    def __hash__(self: Any) -> int:
        return hash(_compared(kind, self))

    return __hash__


def _refusal(action: str) -> Callable[..., None]:
    def refuse(self: Any, name: str, value: object = None) -> None:
        raise FrozenInstanceError(f"cannot {action} field {name!r}")

    return refuse


if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    dataclass = _dataclass

__all__ = ["dataclass"]
