"""Corota: co-rotational planar finite elements.

Names are imported at first use, so that ``corota --version`` does not load the numerics.
"""

# SPDX-License-Identifier: BSD-3-Clause
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from corota import cells, examples, gradients, mesh, plots, profiles
    from corota._core import __version__ as __version__
    from corota.analysis.run import solve
    from corota.cells import PeriodicCell
    from corota.errors import (
        ConvergenceError,
        CorotaError,
        DeckError,
        Diagnostic,
        FileError,
        InputError,
        Interrupted,
        ModelError,
        ResourceError,
        SingularError,
        UnsupportedError,
    )
    from corota.gradients import gradient, optimize, shape, value_and_grad
    from corota.io.formats import read, write
    from corota.io.job import JobFiles
    from corota.io.result_reader import read_results
    from corota.io.resume import resume
    from corota.mesh import Cells, Mesh
    from corota.mesh.geometric import inside, near, on_circle, on_line
    from corota.model.attachments import Dashpot, PointMass
    from corota.model.compiled import CompiledMaterial, Umat
    from corota.model.constraints import Coupling, Equation, LocalAxes, StraightLine
    from corota.model.contact import ContactPair, PressureLaw, RigidCurve, Tie, gap_element
    from corota.model.friction import DecayingFriction, FrictionTable
    from corota.model.hill import Hill
    from corota.model.hyperelastic import (
        ArrudaBoyce,
        Hyperfoam,
        MooneyRivlin,
        NeoHooke,
        Ogden,
        Polynomial,
        Yeoh,
    )
    from corota.model.johnson_cook import JohnsonCook
    from corota.model.loads import (
        Amplitude,
        BodyForce,
        EdgeLoad,
        Fixed,
        Force,
        InitialStress,
        InitialTemperature,
        InitialVelocity,
        NodalForce,
        Temperature,
    )
    from corota.model.local_strain import LOCAL_STRAINS
    from corota.model.material_table import MaterialTable
    from corota.model.materials import Elastic, Expansion, Orthotropic
    from corota.model.model import Findings, Model
    from corota.model.mullins import Mullins
    from corota.model.paths import ArcLength, CriticalPoint, DisplacementControl, Modes
    from corota.model.plasticity import Mises, Voce
    from corota.model.ramberg_osgood import RambergOsgood
    from corota.model.rates import CowperSymonds, Norton, RateCurves, YieldRatio
    from corota.model.sections import Section
    from corota.model.steps import (
        Buckle,
        Dynamic,
        Frequency,
        ModalDynamic,
        Output,
        Static,
        SteadyState,
        Visco,
    )
    from corota.model.user_material import UserMaterial
    from corota.model.viscoelastic import WLF, Viscoelastic
    from corota.results.body_motion import BodyMotion
    from corota.results.history import History
    from corota.results.observer import BaseObserver, Iteration, Observer
    from corota.results.results import Frame, PointFields, Results
    from corota.sweeps import Sweep, grid, sample, sweep
    from corota.sweeps.seek import Sought, seek


#: Public names of each module; the version is that of Cargo.toml.
_NAMES = {
    "": "cells examples gradients mesh plots profiles",
    "_core": "__version__",
    "analysis.run": "solve",
    "cells": "PeriodicCell",
    "errors": "ConvergenceError CorotaError DeckError Diagnostic FileError InputError Interrupted "
    "ModelError ResourceError SingularError UnsupportedError",
    "gradients": "gradient optimize shape value_and_grad",
    "io.formats": "read write",
    "io.job": "JobFiles",
    "io.result_reader": "read_results",
    "io.resume": "resume",
    "mesh": "Cells Mesh",
    "mesh.geometric": "inside near on_circle on_line",
    "model.attachments": "Dashpot PointMass",
    "model.compiled": "CompiledMaterial Umat",
    "model.constraints": "Coupling Equation LocalAxes StraightLine",
    "model.contact": "ContactPair gap_element PressureLaw RigidCurve Tie",
    "model.friction": "DecayingFriction FrictionTable",
    "model.hill": "Hill",
    "model.hyperelastic": "ArrudaBoyce Hyperfoam MooneyRivlin NeoHooke Ogden Polynomial Yeoh",
    "model.johnson_cook": "JohnsonCook",
    "model.loads": "Amplitude BodyForce EdgeLoad Fixed Force InitialStress InitialTemperature "
    "InitialVelocity NodalForce Temperature",
    "model.local_strain": "LOCAL_STRAINS",
    "model.material_table": "MaterialTable",
    "model.materials": "Elastic Expansion Orthotropic",
    "model.model": "Findings Model",
    "model.mullins": "Mullins",
    "model.paths": "ArcLength CriticalPoint DisplacementControl Modes",
    "model.plasticity": "Mises Voce",
    "model.ramberg_osgood": "RambergOsgood",
    "model.rates": "CowperSymonds Norton RateCurves YieldRatio",
    "model.sections": "Section",
    "model.steps": "Buckle Dynamic Frequency ModalDynamic Output Static SteadyState Visco",
    "model.user_material": "UserMaterial",
    "model.viscoelastic": "Viscoelastic WLF",
    "results.body_motion": "BodyMotion",
    "results.history": "History",
    "results.observer": "BaseObserver Iteration Observer",
    "results.results": "Frame PointFields Results",
    "sweeps": "grid sample Sweep sweep",
    "sweeps.seek": "seek Sought",
}
#: Module of each name; those without are modules themselves.
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = [
    "LOCAL_STRAINS",
    "WLF",
    "Amplitude",
    "ArcLength",
    "ArrudaBoyce",
    "BaseObserver",
    "BodyForce",
    "BodyMotion",
    "Buckle",
    "Cells",
    "CompiledMaterial",
    "ContactPair",
    "ConvergenceError",
    "CorotaError",
    "Coupling",
    "CowperSymonds",
    "CriticalPoint",
    "Dashpot",
    "DecayingFriction",
    "DeckError",
    "Diagnostic",
    "DisplacementControl",
    "Dynamic",
    "EdgeLoad",
    "Elastic",
    "Equation",
    "Expansion",
    "FileError",
    "Findings",
    "Fixed",
    "Force",
    "Frame",
    "Frequency",
    "FrictionTable",
    "Hill",
    "History",
    "Hyperfoam",
    "InitialStress",
    "InitialTemperature",
    "InitialVelocity",
    "InputError",
    "Interrupted",
    "Iteration",
    "JobFiles",
    "JohnsonCook",
    "LocalAxes",
    "MaterialTable",
    "Mesh",
    "Mises",
    "ModalDynamic",
    "Model",
    "ModelError",
    "Modes",
    "MooneyRivlin",
    "Mullins",
    "NeoHooke",
    "NodalForce",
    "Norton",
    "Observer",
    "Ogden",
    "Orthotropic",
    "Output",
    "PeriodicCell",
    "PointFields",
    "PointMass",
    "Polynomial",
    "PressureLaw",
    "RambergOsgood",
    "RateCurves",
    "ResourceError",
    "Results",
    "RigidCurve",
    "Section",
    "SingularError",
    "Sought",
    "Static",
    "SteadyState",
    "StraightLine",
    "Sweep",
    "Temperature",
    "Tie",
    "Umat",
    "UnsupportedError",
    "UserMaterial",
    "Visco",
    "Viscoelastic",
    "Voce",
    "Yeoh",
    "YieldRatio",
    "cells",
    "examples",
    "gap_element",
    "gradient",
    "gradients",
    "grid",
    "inside",
    "mesh",
    "near",
    "on_circle",
    "on_line",
    "optimize",
    "plots",
    "profiles",
    "read",
    "read_results",
    "resume",
    "sample",
    "seek",
    "shape",
    "solve",
    "sweep",
    "value_and_grad",
    "write",
]


def __getattr__(name: str) -> Any:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'corota' has no attribute {name!r}")
    try:
        module = import_module(f"corota.{home or name}")
        value = getattr(module, name) if home else module
    except (MemoryError, SystemError) as error:
        from corota.errors import SHORT, ResourceError, is_shortage

        if not is_shortage(error):
            raise
        raise ResourceError(SHORT) from None
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
