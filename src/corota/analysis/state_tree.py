"""The state of an analysis as a tree of plain values and arrays, and back into fresh objects.

All data of an analysis between two increments are state, unless their class excludes them:
attributes that it lists as `recomputed` (linear solvers, memory, clocks, caches) follow from
others, the model is stored by reference, and code is not stored. An attribute that is added later
is therefore part of every checkpoint automatically. Objects of the compiled core export and import
their state as arrays; terms from outside the package declare theirs (:meth:`Term.state`).

Arrays of the system that did not change since it was built are not stored: the tree holds their
digest only, which identifies a system of another model.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import numpy as np

from corota.analysis.linear.triplets import arrays_of
from corota.errors import CorotaError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from corota.analysis.linear.types import Sparse

    Kept = TypeVar("Kept")
#: Part of a tree: dicts, lists, strings, numbers and None, as in JSON.
Tree: TypeAlias = Any

#: Packages whose classes may be made from a tree.
PACKAGES = ("corota.analysis.", "corota.model.", "corota.mesh", "corota.results.", "corota.errors")
#: Modules of the model whose objects are results, not input.
FOUND = ("corota.model.paths",)
#: Bytes of an array of which a copy is kept, until its digest is needed.
SMALL = 1 << 15
#: Kinds of arrays that are stored.
KINDS = "biufcSU"
#: Classes of sparse matrices that may be made from a tree.
SPARSE = [f"{order}_{kind}" for order in ("coo", "csr", "csc") for kind in ("array", "matrix")]


class UnsuitableState(CorotaError):
    """A tree that does not fit the objects to be restored."""


class Unstorable(CorotaError):
    """An object that cannot be stored in a checkpoint."""


def digest(array: NDArray[np.generic]) -> str:
    """Digest of the numbers, shape and type of an array."""
    import hashlib

    plain = np.ascontiguousarray(array)
    own = hashlib.blake2b(f"{plain.dtype.str}{array.shape}".encode(), digest_size=12)
    own.update(plain.data if plain.size else b"")
    return own.hexdigest()


def _is_core(value: object) -> bool:
    return hasattr(type(value), "restore_state")


def _is_code(value: object) -> bool:
    return callable(value) and not hasattr(type(value), "__dataclass_fields__")


def _recomputed(kind: type) -> frozenset[str]:
    """Attributes that a class does not store."""
    return getattr(kind, "recomputed", frozenset())


def _parts(value: object) -> dict[str, object]:
    slots = [name for kind in type(value).__mro__ for name in getattr(kind, "__slots__", ())]
    own = {name: getattr(value, name) for name in slots if hasattr(value, name)}
    return own | getattr(value, "__dict__", {})


class Writer:
    """Turns values into a tree.

    Parameters
    ----------
    known : dict of str to object
        Objects that stand for themselves, by the names that trees have for them.
    as_built : dict of str to str or ndarray
        Arrays by their place, see :func:`arrays_as_built`.
    by_value : bool
        Store objects of the model too.

    Attributes
    ----------
    arrays : list of ndarray
        Numbers of the tree; it refers to them by their index.
    """

    def __init__(
        self,
        known: Mapping[str, object],
        as_built: Mapping[str, object] | None = None,
        by_value: bool = False,
    ) -> None:
        self.arrays: list[NDArray[np.generic]] = []
        self._known = {id(value): name for name, value in known.items()}
        self._as_built = as_built or {}
        self._by_value = by_value
        self._seen: dict[int, int] = {}
        self._alive: list[object] = []  # so that no identity is given twice

    def write(self, value: object, place: str = "") -> Tree:
        """Tree of a value.

        Raises
        ------
        Unstorable
            If something in it is neither plain nor part of this program.
        """
        if value is None or type(value) in (bool, int, float, str):
            return value
        if isinstance(value, np.generic):
            return {"scalar": self._array(np.asarray(value))}
        if type(value) is complex:
            return {"complex": [value.real, value.imag]}
        if type(value) is bytes:
            return {"bytes": value.hex()}
        if (name := self._known.get(id(value))) is not None:
            return {"known": name}
        if (number := self._seen.get(id(value))) is not None:
            return {"again": number}
        if type(value) is tuple:
            return {"tuple": [self.write(v, f"{place}/{i}") for i, v in enumerate(value)]}
        if _is_code(value):
            if self._by_value:
                raise Unstorable(f"{place}: a function cannot be stored in a checkpoint")
            return {"code": True}
        self._seen[id(value)] = number = len(self._alive)
        self._alive.append(value)
        return {"n": number} | self._body(value, place)

    def _body(self, value: Any, place: str) -> Tree:
        if isinstance(value, np.ndarray):
            built = self._as_built.get(place)
            if isinstance(built, np.ndarray):
                built = digest(built)
            if built == (found := digest(value) if self._as_built else ""):
                return {"built": found}
            return self._order(value)
        kind = type(value)
        if isinstance(value, list):
            return {"list": [self.write(v, f"{place}/{i}") for i, v in enumerate(value)]}
        if kind in (set, frozenset):
            return {"set": [self.write(v) for v in sorted(value)]}
        if isinstance(value, dict):
            items = [
                [self.write(k, f"{place}/{i}k"), self.write(v, f"{place}/{k}")]
                for i, (k, v) in enumerate(value.items())
            ]
            return {"dict": items}
        if hasattr(value, "tocsr") and hasattr(value, "format"):
            return self._sparse(value)
        if _is_core(value):
            return {"core": [self._array(part) for part in value.state()]}
        module = kind.__module__
        if module in ("corota._core", "builtins"):
            return {"code": True}
        if not module.startswith(PACKAGES) and hasattr(value, "restore"):
            return {"term": self.write(dict(value.state()), place)}
        if not module.startswith(PACKAGES):
            raise Unstorable(
                f"{place}: a {module}.{kind.__name__} cannot be stored in a checkpoint"
            )
        if isinstance(value, int):
            return {"int": int(value), "class": f"{module}:{kind.__name__}"}
        if module.startswith("corota.model") and module not in FOUND and not self._by_value:
            return {"model": True}
        skip = _recomputed(kind)
        body = {
            name: self.write(part, f"{place}.{name}")
            for name, part in _parts(value).items()
            if name not in skip
        }
        return {"class": f"{module}:{kind.__qualname__}", "parts": body}

    def _order(self, value: NDArray[np.generic]) -> Tree:
        if value.dtype.kind not in KINDS:
            raise Unstorable(f"an array of {value.dtype} cannot be stored in a checkpoint")
        columns = value.flags.f_contiguous and not value.flags.c_contiguous
        body: Tree = {"array": self._array(value.T if columns else value)}
        return body | {"columns": True} if columns else body

    def _array(self, value: ArrayLike) -> int:
        self.arrays.append(np.array(value))
        return len(self.arrays) - 1

    def _sparse(self, value: Sparse) -> Tree:
        return {
            "sparse": type(value).__name__,
            "shape": list(value.shape),
            "parts": [self._array(part) for part in arrays_of(value)],
            "sorted": bool(getattr(value, "has_sorted_indices", True)),
        }


class Reader:
    """Puts a tree into fresh objects.

    Parameters
    ----------
    arrays : sequence of ndarray
        Of the tree.
    known : dict of str to object
        As those of the :class:`Writer`.
    built : dict of str to ndarray, optional
        Arrays that the objects were built with, by digest, where they have changed since.
    """

    def __init__(
        self,
        arrays: Sequence[NDArray[np.generic]],
        known: Mapping[str, object],
        built: Mapping[str, NDArray[np.generic]] | None = None,
    ) -> None:
        self._arrays, self._known, self._built = arrays, known, built or {}
        self._made: dict[int, object] = {}
        self._taken: dict[int, object] = {}  # fresh objects that have their state already

    def read(self, tree: Tree, fresh: object = None) -> Any:
        """The value of a tree; `fresh` is what stands in its place, and is used if it fits.

        Raises
        ------
        UnsuitableState
            If the tree belongs to something else, or is no tree of a :class:`Writer`.
        """
        try:
            return self._value(tree, fresh)
        except (LookupError, TypeError, ValueError, AttributeError, RecursionError) as error:
            raise UnsuitableState(f"its contents are damaged: {error!r:.200}") from None

    def _value(self, tree: Tree, fresh: object = None) -> Any:
        if not isinstance(tree, dict):
            return tree
        if "known" in tree:
            if tree["known"] not in self._known:
                raise UnsuitableState(f"nothing is named {tree['known']}")
            return self._known[tree["known"]]
        if "again" in tree:
            return self._made[tree["again"]]
        if "tuple" in tree:
            old = fresh if isinstance(fresh, tuple) else ()
            return tuple(self._value(t, f) for t, f in _beside(tree["tuple"], old))
        if "code" in tree and "n" not in tree:
            return fresh
        if "scalar" in tree:
            return self._arrays[tree["scalar"]][()]
        if "complex" in tree:
            return complex(*tree["complex"])
        if "bytes" in tree:
            return bytes.fromhex(tree["bytes"])
        if "built" not in tree and fresh is not None and id(fresh) in self._taken:
            fresh = None  # two places that were one when they were new
        return self._whole(tree, fresh)

    def _whole(self, tree: Tree, fresh: object) -> object:
        number = tree["n"]
        if "list" in tree:
            old: Any = list(fresh) if isinstance(fresh, list) else []
            out: Any = self._keep(number, fresh if isinstance(fresh, list) else [])
            out[:] = [self._value(t, f) for t, f in _beside(tree["list"], old)]
        elif "dict" in tree:
            old = dict(fresh) if isinstance(fresh, dict) else {}
            out = self._keep(number, fresh if isinstance(fresh, dict) else {})
            out.clear()
            for key, part in tree["dict"]:
                name = self._value(key)
                out[name] = self._value(part, old.get(name))
        elif "set" in tree:
            out = self._keep(number, fresh if isinstance(fresh, set) else set())
            out.clear()
            out.update(self._value(t) for t in tree["set"])
        elif "class" in tree and "parts" in tree:
            out = self._object(tree, fresh)
        else:
            out = self._keep(number, self._leaf(tree, fresh))
        return out

    def _leaf(self, tree: Tree, fresh: Any) -> object:
        if "array" in tree:
            value = self._arrays[tree["array"]].copy()  # the analysis changes it in place
            return value.T if tree.get("columns") else value
        if "built" in tree:
            if isinstance(fresh, np.ndarray) and digest(fresh) == tree["built"]:
                return fresh
            if tree["built"] not in self._built:
                raise UnsuitableState("an array of the model differs")
            return self._built[tree["built"]].copy()
        if "core" in tree:
            if not _is_core(fresh):
                raise UnsuitableState("part of the core is missing")
            try:
                fresh.restore_state(*(self._arrays[i] for i in tree["core"]))
            except (ValueError, TypeError) as error:
                raise UnsuitableState(str(error)) from None
            return fresh
        if "term" in tree:
            if not hasattr(fresh, "restore"):
                raise UnsuitableState("a user-defined term is missing")
            fresh.restore(self._value(tree["term"]))
            return fresh
        if "sparse" in tree:
            import scipy.sparse

            if tree["sparse"] not in SPARSE:
                raise UnsuitableState(f"{tree['sparse']} is not a sparse array")
            first, second, data = (self._arrays[i] for i in tree["parts"])
            coo = tree["sparse"].startswith("coo")
            given = (data, (first, second)) if coo else (data, second, first)
            out = getattr(scipy.sparse, tree["sparse"])(given, shape=tuple(tree["shape"]))
            if not coo:
                out.has_sorted_indices = tree["sorted"]
            return out
        if "int" in tree:
            return _class(tree["class"])(tree["int"])
        if "model" in tree or "code" in tree:
            return fresh
        raise UnsuitableState("a part of the tree has an unknown kind")

    def _object(self, tree: Tree, fresh: object) -> object:
        kind = _class(tree["class"])
        own = fresh if type(fresh) is kind else kind.__new__(kind)
        self._keep(tree["n"], own)
        for name in () if own is fresh else _recomputed(kind):
            if not hasattr(kind, name):  # a property computes it again
                object.__setattr__(own, name, None)
        for name, part in tree["parts"].items():
            old = _parts(own).get(name)
            value = self._value(part, old)
            if value is None and isinstance(part, dict):
                continue  # code that a new object has to be given
            object.__setattr__(own, name, value)
        return own

    def _keep(self, number: int, value: Kept) -> Kept:
        self._made[number] = value
        if value is not None:
            self._taken[id(value)] = value
        return value


def dict_of(tree: Tree) -> dict[str, Tree]:
    """Trees of the values of a dict with names for keys."""
    return dict(tree["dict"])


def _beside(trees: list[Tree], fresh: Sequence[object]) -> Iterator[tuple[Tree, object]]:
    for i, tree in enumerate(trees):
        yield tree, fresh[i] if i < len(fresh) else None


#: Modules that were renamed within a format, by their former names.
RENAMED = {
    f"corota.analysis.terms.contact.{former}": "corota.analysis.terms.contact.motion"
    for former in ("newton", "forward")
}


def _class(name: str) -> Any:
    module, _, path = name.partition(":")
    module = RENAMED.get(module, module)
    if not module.startswith(PACKAGES):
        raise UnsuitableState(f"{module} cannot be part of a state")
    try:
        found: Any = sys.modules.get(module) or import_module(module)
        for part in path.split("."):
            found = getattr(found, part)
    except (ImportError, AttributeError):
        raise UnsuitableState(f"this program has no {path}") from None
    if not isinstance(found, type) or found.__module__ != module:
        raise UnsuitableState(f"{path} is not a class of this program")
    return found


def arrays_as_built(
    value: object, known: Mapping[str, object], place: str
) -> dict[str, str | NDArray[np.generic]]:
    """The arrays of a value by their place: copies of small ones, digests of others.

    Digests of small arrays are needed for a checkpoint only, which small jobs do not write.
    """
    found = _Digests(known, keep=SMALL)
    found.write(value, place)
    return found.digests


def copies_as_built(value: object, known: Mapping[str, object]) -> dict[str, NDArray[np.generic]]:
    """Copies of the arrays of a value by their digest."""
    found = _Digests(known, copy=True)
    found.write(value, "")
    return found.copies


class _Digests(Writer):
    """A writer that only notes where arrays are."""

    def __init__(self, known: Mapping[str, object], copy: bool = False, keep: int = -1) -> None:
        super().__init__(known)
        self.digests: dict[str, str | NDArray[np.generic]] = {}
        self.copies: dict[str, NDArray[np.generic]] = {}
        self._copy, self._keep = copy, keep

    def _order(self, value: NDArray[np.generic]) -> Tree:
        raise AssertionError

    def _body(self, value: object, place: str) -> Tree:
        if isinstance(value, np.ndarray):
            if value.nbytes <= self._keep:
                self.digests[place] = value.copy()
                return {}
            self.digests[place] = found = digest(value)
            if self._copy:
                self.copies[found] = value.copy()
            return {}
        if _is_core(value):
            return {}
        return super()._body(value, place)


def digest_of(tree: Tree, arrays: Sequence[NDArray[np.generic]]) -> str:
    """Digest of a tree with its arrays; where things were read from does not count."""
    import hashlib
    import json

    own = hashlib.sha256(json.dumps(_without_places(tree), sort_keys=True).encode())
    for array in arrays:
        own.update(digest(array).encode())
    return own.hexdigest()


def _without_places(tree: Tree) -> Tree:
    if isinstance(tree, dict):
        return {k: _without_places(v) for k, v in tree.items() if k not in ("where", "notes")}
    if isinstance(tree, list):
        return [_without_places(v) for v in tree]
    return tree
