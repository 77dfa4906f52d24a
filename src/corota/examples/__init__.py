"""Example models, included in the wheel; they need no file and no network.

``ct.examples.load("gripper")`` gives a model with its steps; ``corota demo gripper`` runs it.
Each is a plain :class:`corota.Model` that can be changed.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from corota.examples.models import MODELS
from corota.names import choose

if TYPE_CHECKING:
    from corota.model.model import Model

__all__ = ["describe", "load", "names", "path"]


def names() -> list[str]:
    """Names for :func:`load`.

    Examples
    --------
    >>> import corota as ct
    >>> ct.examples.names()
    ['bistable', 'clip', 'gripper', 'hinge', 'rollup', 'seal']
    """
    return sorted(MODELS)


def describe(name: str) -> str:
    """Description of an example in one line.

    Raises
    ------
    InputError
        If there is no such example.
    """
    text = MODELS[choose(name, names(), "example")].__doc__ or ""
    return text.splitlines()[0]


def load(name: str) -> Model:
    """Build the model of an example, with its steps.

    Parameters
    ----------
    name : str
        One of :func:`names`, in any case.

    Raises
    ------
    InputError
        If there is no such example; with the nearest name.

    Examples
    --------
    >>> import corota as ct
    >>> model = ct.examples.load("rollup")
    >>> results = ct.solve(model, threads=1)
    >>> round(float(results.frames[-1].UR.max()), 1)  # a full turn
    6.3
    """
    return MODELS[choose(name, names(), "example")]()


def path(file: str) -> Path:
    """Path of a file of the examples: ``"gripper.msh"``, a mesh, ``"four_bar.dxf"``, a drawing.

    Raises
    ------
    InputError
        If there is no such file.
    """
    here = Path(__file__).resolve().parent
    files = [p.name for p in here.iterdir() if p.suffix in (".msh", ".inp", ".dxf")]
    return here / choose(file, sorted(files), "file of the examples")
