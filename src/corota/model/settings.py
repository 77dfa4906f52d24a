"""Data classes whose settings act whenever they are given: at construction or later."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import fields
from typing import Any, ClassVar


class _Ready(type):
    """Marks objects whose construction is complete."""

    def __call__(cls, *args: Any, **options: Any) -> Any:
        made = super().__call__(*args, **options)
        vars(made)["_complete"] = True
        return made


class Settings(metaclass=_Ready):
    """Base of data classes with settings that follow from others.

    A setting that is changed later is checked, and what follows from it is derived again, as if the
    object had been constructed with it. Of two that exclude each other the later one counts
    (:attr:`excludes`).

    Examples
    --------
    >>> import corota as ct
    >>> step = ct.Static()
    >>> step.increments = 10
    >>> step.first_increment
    0.1
    >>> step.period = 2.0
    >>> step.first_increment
    0.2
    """

    #: Setting to another one that loses its value when it is changed, with the value it gets.
    excludes: ClassVar[dict[str, tuple[str, Any]]] = {}

    def __setattr__(self, name: str, value: Any) -> None:
        own = vars(self)
        if "_complete" not in own:
            own.setdefault("_given", {}).setdefault(name, value)  # the first one is the caller's
            own[name] = value
            return
        names = {item.name for item in fields(self) if item.init}  # type: ignore[arg-type]
        if name not in names:
            known = ", ".join(sorted(names))
            kind = type(self).__name__
            raise AttributeError(f"{kind} has no setting {name!r}; there are {known}")
        given = {k: v for k, v in own["_given"].items() if k in names} | {name: value}
        if name in self.excludes:
            other, reset = self.excludes[name]
            given[other] = reset
        own.update(vars(type(self)(**given)))
