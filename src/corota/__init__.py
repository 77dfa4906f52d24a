"""Corota: co-rotational planar finite elements.

Names are imported when first used, so that ``corota --version`` need not wait for numerics.
"""

# SPDX-License-Identifier: BSD-3-Clause
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from corota import mesh
    from corota.contact import PressureLaw, RigidCurve
    from corota.drivers.analysis import solve
    from corota.errors import (
        ConvergenceError,
        CorotaError,
        DeckError,
        InputError,
        ModelError,
        SingularError,
        UnsupportedError,
    )
    from corota.io.formats import read
    from corota.io.job import JobFiles
    from corota.io.stored import read_results
    from corota.materials import Elastic, Expansion, Orthotropic
    from corota.materials_plastic import Mises, Voce
    from corota.materials_user import UserMaterial
    from corota.mesh import Mesh
    from corota.model import Amplitude, Model
    from corota.paths import ArcLength, DisplacementControl
    from corota.results import Results
    from corota.steps import Buckle, Dynamic, Frequency, ModalDynamic, Static, SteadyState

__version__ = "0.1.0"

#: Module of each public name; a module stands for itself.
_HOMES = {
    "Amplitude": "model",
    "ArcLength": "paths",
    "Buckle": "steps",
    "ConvergenceError": "errors",
    "CorotaError": "errors",
    "DeckError": "errors",
    "DisplacementControl": "paths",
    "Dynamic": "steps",
    "Elastic": "materials",
    "Expansion": "materials",
    "Frequency": "steps",
    "InputError": "errors",
    "JobFiles": "io.job",
    "Mesh": "mesh",
    "Mises": "materials_plastic",
    "ModalDynamic": "steps",
    "Model": "model",
    "ModelError": "errors",
    "Orthotropic": "materials",
    "PressureLaw": "contact",
    "Results": "results",
    "RigidCurve": "contact",
    "SingularError": "errors",
    "Static": "steps",
    "SteadyState": "steps",
    "UnsupportedError": "errors",
    "UserMaterial": "materials_user",
    "Voce": "materials_plastic",
    "mesh": "",
    "read": "io.formats",
    "read_results": "io.stored",
    "solve": "drivers.analysis",
}

__all__ = [
    "Amplitude",
    "ArcLength",
    "Buckle",
    "ConvergenceError",
    "CorotaError",
    "DeckError",
    "DisplacementControl",
    "Dynamic",
    "Elastic",
    "Expansion",
    "Frequency",
    "InputError",
    "JobFiles",
    "Mesh",
    "Mises",
    "ModalDynamic",
    "Model",
    "ModelError",
    "Orthotropic",
    "PressureLaw",
    "Results",
    "RigidCurve",
    "SingularError",
    "Static",
    "SteadyState",
    "UnsupportedError",
    "UserMaterial",
    "Voce",
    "mesh",
    "read",
    "read_results",
    "solve",
]


def __getattr__(name: str) -> Any:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'corota' has no attribute {name!r}")
    module = import_module(f"corota.{home or name}")
    value = getattr(module, name) if home else module
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
