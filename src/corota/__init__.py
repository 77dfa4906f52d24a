"""Corota: co-rotational planar finite elements.

Names are imported when first used, so that ``corota --version`` need not wait for numerics.
"""

# SPDX-License-Identifier: BSD-3-Clause
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from corota import mesh
    from corota._core import __version__ as __version__
    from corota.analysis.run import solve
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
    from corota.io.result_reader import read_results
    from corota.mesh import Mesh
    from corota.model.contact import PressureLaw, RigidCurve
    from corota.model.loads import Amplitude
    from corota.model.local_strain import LOCAL_STRAINS
    from corota.model.materials import Elastic, Expansion, Orthotropic
    from corota.model.model import Model
    from corota.model.paths import ArcLength, DisplacementControl
    from corota.model.plasticity import Mises, Voce
    from corota.model.steps import Buckle, Dynamic, Frequency, ModalDynamic, Static, SteadyState
    from corota.model.user_material import UserMaterial
    from corota.results.results import Results


#: Module of each public name; a module stands for itself.
_HOMES = {
    "__version__": "_core",  # that of Cargo.toml
    "Amplitude": "model.loads",
    "ArcLength": "model.paths",
    "Buckle": "model.steps",
    "ConvergenceError": "errors",
    "CorotaError": "errors",
    "DeckError": "errors",
    "DisplacementControl": "model.paths",
    "Dynamic": "model.steps",
    "Elastic": "model.materials",
    "Expansion": "model.materials",
    "Frequency": "model.steps",
    "InputError": "errors",
    "LOCAL_STRAINS": "model.local_strain",
    "JobFiles": "io.job",
    "Mesh": "mesh",
    "Mises": "model.plasticity",
    "ModalDynamic": "model.steps",
    "Model": "model.model",
    "ModelError": "errors",
    "Orthotropic": "model.materials",
    "PressureLaw": "model.contact",
    "Results": "results.results",
    "RigidCurve": "model.contact",
    "SingularError": "errors",
    "Static": "model.steps",
    "SteadyState": "model.steps",
    "UnsupportedError": "errors",
    "UserMaterial": "model.user_material",
    "Voce": "model.plasticity",
    "mesh": "",
    "read": "io.formats",
    "read_results": "io.result_reader",
    "solve": "analysis.run",
}

__all__ = [
    "LOCAL_STRAINS",
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
