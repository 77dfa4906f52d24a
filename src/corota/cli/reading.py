"""Reading input files with the options of the command line."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import Any

from corota import mesh as meshes
from corota.errors import FileError
from corota.model.model import Model

#: Endings of result files that the commands can open again.
RESULTS = (".vtkhdf", ".hdf", ".frd", ".pvd", ".vtu")


def read_input(name: str, args: Any) -> Model:
    """Read a deck or a mesh.

    Raises
    ------
    FileError
        If the file cannot be opened.
    InputError
        If its contents cannot be accepted.
    """
    from corota.io.formats import MODEL_READERS, read

    path = Path(name)
    if not path.exists():
        raise FileError(f"{path}: no such file")
    if path.is_dir():
        raise FileError(f"{path}: is a folder, not a file")
    if path.suffix.lower() not in MODEL_READERS:
        mesh = meshes.read(path)
        return Model(mesh, path.stem)
    return read(path, parameters=dict(getattr(args, "parameters", ())), **reading_options(args))


def reading_options(args: Any) -> dict[str, Any]:
    """Options of :func:`corota.io.formats.read` from the command line, but the parameters."""
    return {
        "element_map": dict(args.elements),
        "lenient": args.lenient,
        "allow_include": args.allow_include,
        "as_written": args.as_written,
        "stages": tuple(getattr(args, "stages", ())),
        "library": getattr(args, "library", None),
    }


def is_result(name: str) -> bool:
    """Whether a file name is that of results."""
    return Path(name).suffix.lower() in RESULTS
