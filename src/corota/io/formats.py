"""The one table of readers and writers of models, by the end of the file's name."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from corota.errors import InputError, UnsupportedError, memory_errors
from corota.io.deck.read import read_deck
from corota.lazy import lazy

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Mapping, Sequence

    from corota.mesh.data import Mesh
    from corota.model.model import Model
    from corota.model.steps import Step


def _deck_mesh(path: str | os.PathLike[str]) -> Mesh:
    model = read_deck(path)
    model.mesh.notes += model.notes
    return model.mesh


#: Readers of models.
MODEL_READERS: dict[str, Callable[..., Model]] = {".inp": read_deck}
#: Writers of models.
MODEL_WRITERS: dict[str, Callable[..., Path]] = {
    ".inp": lazy("corota.io.deck.write.model:write_deck")
}
#: Readers of meshes; other names are passed to meshio.
MESH_READERS: dict[str, Callable[..., Mesh]] = {
    ".msh": lazy("corota.io.gmsh.reader:read_gmsh"),
    ".inp": _deck_mesh,
    ".unv": lazy("corota.io.unv:read_unv"),
}


def read(
    path: str | os.PathLike[str],
    *,
    element_map: Mapping[str, str] | None = None,
    lenient: bool = False,
    allow_include: bool = False,
    as_written: bool = False,
    parameters: Mapping[str, float] | None = None,
    stages: Sequence[str] = (),
    library: str | os.PathLike[str] | None = None,
) -> Model:
    """Read a model from a deck.

    Parameters
    ----------
    path : path-like
        A CalculiX or Abaqus deck, ``.inp``.
    element_map : mapping of str to str, optional
        Element names to replace, such as ``{"CPS4": "Q4D"}``; the plane state stays.
    lenient : bool, optional
        Warn about unknown keywords and parameters instead of refusing them.
    allow_include : bool, optional
        Let ``*INCLUDE`` leave the deck's folder.
    as_written : bool, optional
        Take reduced integration literally (CPS4R becomes Q4R instead of Q4I).
    parameters : mapping of str to float, optional
        Values of ``*PARAMETER`` names that replace those of the deck.
    stages : sequence of str, optional
        Bodies that are measured, such as ``"HUB axis=rotation"``
        (:meth:`corota.model.stages.Stages.add_stage`).
    library : path-like, optional
        Library with the UMAT of ``*USER MATERIAL``. Its code is loaded: name one that you trust.

    Returns
    -------
    Model

    Raises
    ------
    DeckError
        With all the faults of the deck.
    FileError
        If a file cannot be read.
    UnsupportedError
        If no reader fits the file's name.
    ResourceError
        If the memory does not suffice.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in MODEL_READERS:
        raise UnsupportedError(
            f"{path}: no reader of models for {suffix or 'a file without an extension'}; "
            f"known: {', '.join(MODEL_READERS)} (meshes: corota.mesh.read)"
        )
    with memory_errors():
        model: Model = MODEL_READERS[suffix](
            path,
            element_map=element_map,
            lenient=lenient,
            allow_include=allow_include,
            as_written=as_written,
            parameters=parameters,
            library=library,
        )
        for text in stages:
            model.add_stage(text)
    return model


def write(
    model: Model | Mesh,
    path: str | os.PathLike[str],
    steps: Step | Sequence[Step] | None = None,
) -> Path:
    """Write a model or a mesh in the format of the file extension; return the path.

    Parameters
    ----------
    model : Model or Mesh
    path : path-like
        ``.inp`` for a deck.
    steps : Step or sequence of Step, optional
        Steps to write, as :func:`corota.solve` takes them; those of the model by default.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If the object is neither a model nor a mesh, or steps are given with a mesh.
    UnsupportedError
        If no writer fits the name, or the format cannot represent the model.
    FileError
        If the file cannot be written.
    """
    from corota.io.writers import write_mesh
    from corota.mesh.data import Mesh
    from corota.model.model import Model

    if isinstance(model, Mesh):
        if steps is not None:
            raise InputError("a mesh has no steps: write the model instead")
        return write_mesh(model, path)
    if not isinstance(model, Model):
        raise InputError(
            f"a {type(model).__name__} is neither a model nor a mesh (results have a write method)"
        )
    suffix = Path(path).suffix.lower()
    if suffix not in MODEL_WRITERS:
        raise UnsupportedError(
            f"{path}: no writer of models for {suffix or 'a file without an extension'}; "
            f"known: {', '.join(MODEL_WRITERS)}"
        )
    return MODEL_WRITERS[suffix](model, path, steps)


def read_mesh(path: str | os.PathLike[str]) -> Mesh:
    """Read a mesh; see :func:`corota.mesh.read`."""
    other: Callable[..., Mesh] = lazy("corota.io.meshio_bridge:read_meshio")
    return MESH_READERS.get(Path(path).suffix.lower(), other)(path)
