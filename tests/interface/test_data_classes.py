"""Data classes of the package beside those of the standard library."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import inspect
import pickle
import pkgutil
import re
from dataclasses import FrozenInstanceError, field, fields, make_dataclass, replace
from importlib import import_module
from pathlib import Path

import pytest

import corota
from corota.data_classes import dataclass
from corota.errors import Location

#: Types of defaults that stand for a value made for each object.
FACTORY = ("_Absent", "_HAS_DEFAULT_FACTORY_CLASS")


@dataclass
class Base:
    a: int
    b: list[int] = field(default_factory=list)
    c: int = field(default=7, init=False)
    hidden: float = field(default=0.5, repr=False, compare=False)


@dataclass(kw_only=True)
class Derived(Base):
    d: str = "d"
    e: float


@dataclass(frozen=True)
class Fixed:
    a: int
    b: str = "b"


@dataclass(slots=True, eq=False, repr=False)
class Slotted:
    a: int
    b: dict[str, int] = field(default_factory=dict)
    c: int = 0

    def __post_init__(self) -> None:
        self.c += 1


@dataclass
class Nested:
    inside: object = None


def all_classes() -> list[type]:
    """Every data class of the package."""
    found = {}
    for module in pkgutil.walk_packages(corota.__path__, "corota."):
        if module.name.endswith("__main__") or module.name.startswith("corota.verification"):
            continue
        for value in vars(import_module(module.name)).values():
            if isinstance(value, type) and "__dataclass_fields__" in vars(value):
                found[f"{value.__module__}.{value.__qualname__}"] = value
    return [found[name] for name in sorted(found)]


def arguments(kind: type) -> list[tuple[object, ...]]:
    """Arguments of ``__init__``; a value that is made for each object is ``<factory>``."""
    found = inspect.signature(kind).parameters.values()
    factory = "<factory>"
    return [
        (
            p.name,
            p.kind,
            p.annotation,
            factory if type(p.default).__name__ in FACTORY else p.default,
        )
        for p in found
    ]


def test_every_class_is_made_as_by_the_standard_library() -> None:
    classes = all_classes()
    assert len(classes) > 100
    for kind in classes:
        if kind.__init__.__code__.co_filename != "<string>":
            continue  # it has one of its own
        items = [(item.name, item.type, item) for item in fields(kind)]
        twin = make_dataclass(kind.__name__, items, namespace={"__doc__": kind.__doc__ or "twin"})
        assert arguments(kind) == arguments(twin), kind


def test_the_package_uses_no_other_data_classes() -> None:
    source = Path(corota.__file__).parent
    other = re.compile(r"^ *from dataclasses import .*\bdataclass\b", re.MULTILINE)
    found = [p.name for p in source.rglob("*.py") if other.search(p.read_text(encoding="utf-8"))]
    assert found == ["data_classes.py"]


def test_methods_are_those_of_the_standard_library() -> None:
    one, other = Base(1), Base(1, [])
    assert one == other
    assert one != Base(2)
    assert one != Derived(1, e=2.0)
    assert one == replace(one, hidden=3.0)
    assert repr(one) == "Base(a=1, b=[], c=7)"
    assert repr(Derived(1, e=2.0)) == "Derived(a=1, b=[], c=7, d='d', e=2.0)"
    with pytest.raises(TypeError, match="unhashable"):
        hash(one)
    with pytest.raises(TypeError, match=r"Derived.__init__\(\) missing 1 required keyword-only"):
        Derived(1)
    assert hash(Fixed(1)) == hash(Fixed(1, "b"))
    assert Fixed.__match_args__ == ("a", "b")


def test_objects_of_a_frozen_class_do_not_change() -> None:
    made = Fixed(1)
    with pytest.raises(FrozenInstanceError, match="cannot assign to field 'a'"):
        made.a = 2
    with pytest.raises(FrozenInstanceError, match="cannot delete field 'a'"):
        del made.a
    assert replace(made, a=2) == Fixed(2)


def test_slots() -> None:
    made = Slotted(1)
    assert not hasattr(made, "__dict__")
    assert (made.b, made.c) == ({}, 1)
    assert made.b is not Slotted(1).b


def test_objects_that_hold_themselves_are_shown() -> None:
    made = Nested()
    made.inside = made
    assert repr(made) == "Nested(inside=...)"


def test_objects_are_pickled() -> None:
    for made in (Base(1), Fixed(2), Location("deck.inp", 3)):
        assert pickle.loads(pickle.dumps(made)) == made
    assert pickle.loads(pickle.dumps(Slotted(1))).c == 1


def test_methods_are_compiled_once_and_late() -> None:
    @dataclass
    class Late:
        a: int

    assert not inspect.isfunction(vars(Late)["__init__"])
    Late(1)
    assert inspect.isfunction(vars(Late)["__init__"])
