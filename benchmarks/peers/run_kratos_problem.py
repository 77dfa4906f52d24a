"""A contact problem with Kratos: total-Lagrangian elements, mortar contact.

``python -m benchmarks.peers.run_kratos_problem DATA.json KIND INCREMENTS ...`` with the kind of
contact (``ALM`` or ``Penalty``) and the number of equal increments of each step. For each increment
it writes a line: its time, the reactions of the watched nodes, its iterations. Settings are the
defaults of Kratos, except for a sparse LU solver, three steps in the buffer, which friction needs,
and at most :data:`MOST` iterations, as in its own tests of contact, instead of 10.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import math
import sys
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import KratosMultiphysics as Kratos
import KratosMultiphysics.StructuralMechanicsApplication as Mechanics
from KratosMultiphysics.StructuralMechanicsApplication import structural_mechanics_analysis

from benchmarks.peers.contact_data import ContactData

if TYPE_CHECKING:
    from collections.abc import Iterator

CONTACT = "KratosMultiphysics.ContactStructuralMechanicsApplication"
ELEMENTS = {"T3": "TotalLagrangianElement2D3N", "Q4": "TotalLagrangianElement2D4N"}
LAWS = {
    "strain": "LinearElasticPlaneStrain2DLaw",
    "stress": "LinearElasticPlaneStress2DLaw",
}
MOST = 20


def write_mesh(data: ContactData) -> list[tuple[str, list[str], float]]:
    """Write ``job.mdpa``; the parts of each contact: its name, its slaves, its friction."""
    lines = ["Begin Properties 0", "End Properties", "Begin Properties 1", "End Properties"]
    lines.append("Begin Nodes")
    nodes = sorted({*data.used, *(node for tool in data.tools for node in tool.nodes)})
    for k in nodes:
        x, y = data.points[k]
        lines.append(f"{k + 1} {x:.16g} {y:.16g} 0.0")
    lines.append("End Nodes")
    number = 0
    for name, cells in (
        (ELEMENTS[data.element], data.cells),
        (ELEMENTS["Q4"], [cell for tool in data.tools for cell in tool.cells]),
    ):
        lines.append(f"Begin Elements {name}")
        for cell in cells:
            number += 1
            lines.append(f"{number} 1 {' '.join(str(node + 1) for node in cell)}")
        lines.append("End Elements")
    lines.append("Begin Conditions LineCondition2D2N")
    parts: dict[str, tuple[list[int], list[int], list[int]]] = {
        "All": (nodes, list(range(1, number + 1)), [])
    }
    # Pairs of one slave are one contact: its multipliers are shared.
    groups: dict[str, list[Any]] = {}
    for pair in data.pairs:
        groups.setdefault(json.dumps([pair.slave.edges, pair.friction]), []).append(pair)
    contacts = []
    count = 0
    for i, pairs in enumerate(groups.values()):
        faces = [pairs[0].slave, *(pair.master for pair in pairs)]
        both: list[int] = []
        for k, face in enumerate(faces):
            first = count
            for a, b in face.edges:
                count += 1
                lines.append(f"{count} 1 {a + 1} {b + 1}")
            numbers = list(range(first + 1, count + 1))
            if k == 0:
                ends = sorted({node for edge in face.edges for node in edge})
                parts[f"Slave{i}"] = (ends, [], numbers)
            both += numbers
        ends = sorted({node for face in faces for edge in face.edges for node in edge})
        parts[f"Contact{i}"] = (ends, [], both)
        contacts.append((f"Contact{i}", [f"Slave{i}"], pairs[0].friction))
    lines.append("End Conditions")
    if data.forces:
        lines.append("Begin Conditions PointLoadCondition2D1N")
        for node, _, _ in data.forces:
            count += 1
            lines.append(f"{count} 1 {node + 1}")
        lines.append("End Conditions")
        loaded = list(range(count - len(data.forces) + 1, count + 1))
        parts["Loaded"] = ([node for node, _, _ in data.forces], [], loaded)
    for name, (some, elements, conditions) in parts.items():
        lines.append(f"Begin SubModelPart {name}")
        for kind, numbers in (
            ("Nodes", [node + 1 for node in some]),
            ("Elements", elements),
            ("Conditions", conditions),
        ):
            lines.append(f"Begin SubModelPart{kind}")
            lines += [str(n) for n in numbers]
            lines.append(f"End SubModelPart{kind}")
        lines.append("End SubModelPart")
    Path("job.mdpa").write_text("\n".join(lines) + "\n", encoding="ascii")
    return contacts


def parameters(data: ContactData, kind: str) -> dict[str, Any]:
    """Settings of the analysis; writes the files of mesh and material."""
    law = {
        "constitutive_law": {"name": LAWS[data.plane]},
        "Variables": {
            "YOUNG_MODULUS": data.young,
            "POISSON_RATIO": data.poisson,
            "THICKNESS": data.thickness,
            "DENSITY": data.density,
        },
        "Tables": {},
    }
    entry = {"model_part_name": "Structure.All", "properties_id": 1, "Material": law}
    Path("material.json").write_text(json.dumps({"properties": [entry]}), encoding="ascii")
    contacts = write_mesh(data)
    rough = any(friction for _, _, friction in contacts)
    slip = "Frictional" if rough else "Frictionless"
    contact: dict[str, Any] = {
        "model_part_name": "Structure",
        "assume_master_slave": {str(i): slaves for i, (_, slaves, _) in enumerate(contacts)},
        "contact_model_part": {str(i): [name] for i, (name, _, _) in enumerate(contacts)},
        "contact_type": slip,
    }
    if rough:
        contact["friction_coefficients"] = {str(i): mu for i, (_, _, mu) in enumerate(contacts)}
    process = {
        "python_module": f"{kind.lower()}_contact_process",
        "kratos_module": CONTACT,
        "process_name": "contact",
        "Parameters": contact,
    }
    return {
        "problem_data": {
            "problem_name": "job",
            "parallel_type": "OpenMP",
            "start_time": 0.0,
            "end_time": data.period,
            "echo_level": 0,
        },
        "solver_settings": {
            "model_part_name": "Structure",
            "domain_size": 2,
            "solver_type": "Static",
            "buffer_size": 3,
            "echo_level": 0,
            "analysis_type": "non_linear",
            "model_import_settings": {"input_type": "mdpa", "input_filename": "job"},
            "material_import_settings": {"materials_filename": "material.json"},
            "contact_settings": {"mortar_type": f"{kind}Contact{slip}" if contacts else ""},
            "time_stepping": {"time_step": 1.0},
            "convergence_criterion": (
                "contact_residual_criterion" if contacts else "residual_criterion"
            ),
            "max_iteration": MOST,
            "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
        },
        "processes": {"contact_process_list": [process] if contacts else []},
    }


class Drive(Kratos.Process):  # type: ignore[misc]
    """Moves supports and tools and sets loads, also in the parts of a split increment."""

    def __init__(self, part: Any, data: ContactData) -> None:
        super().__init__()
        self.part, self.data = part, data

    def ExecuteInitializeSolutionStep(self) -> None:
        now, begin = self.part.ProcessInfo[Kratos.TIME], 0.0
        old: dict[tuple[int, int], float] = {}
        for number, stage in enumerate(self.data.stages):
            share = min((now - begin) / stage.period, 1.0)
            for n, dof, value in stage.driven:
                node, variable = self.part.GetNode(n + 1), _displacement(dof)
                before = old.get((n, dof), 0.0)
                node.Fix(variable)
                node.SetSolutionStepValue(variable, before + share * (value - before))
            if number == 0:
                self._load(share)
            begin += stage.period
            if now < begin + 1e-9 * stage.period:
                return
            old |= {(n, dof): value for n, dof, value in stage.driven}

    def _load(self, share: float) -> None:
        for node, x, y in self.data.forces:
            force = [share * x, share * y, 0.0]
            self.part.GetNode(node + 1).SetSolutionStepValue(Mechanics.POINT_LOAD, force)
        if tuple(self.data.gravity) != (0.0, 0.0):
            weight = [share * self.data.gravity[0], share * self.data.gravity[1], 0.0]
            for node in self.part.Nodes:
                node.SetSolutionStepValue(Kratos.VOLUME_ACCELERATION, weight)


class Analysis(structural_mechanics_analysis.StructuralMechanicsAnalysis):
    """An analysis of a problem."""

    def __init__(self, settings: dict[str, Any], data: ContactData) -> None:
        super().__init__(Kratos.Model(), Kratos.Parameters(json.dumps(settings)))
        self.data = data
        self.drive = Drive(self.model["Structure"], data)

    def rows(self, increments: list[int]) -> Iterator[dict[str, Any]]:
        """Run increments, up to the first that does not converge; the account of each.

        Parameters
        ----------
        increments : list of int
            Of each step.
        """
        part = self.model["Structure"]
        watched = [part.GetNode(node + 1) for node in self.data.watched]
        times, begin = [], 0.0
        for stage, count in zip(self.data.stages, increments, strict=True):
            times += [begin + stage.period * k / count for k in range(1, count + 1)]
            begin += stage.period
        for time in times:
            settings = self._GetSolver().settings["time_stepping"]["time_step"]
            settings.SetDouble(time - self.time)
            self.time = self._AdvanceTime()
            self.InitializeSolutionStep()
            converged = self._GetSolver().SolveSolutionStep()
            self.FinalizeSolutionStep()
            self.OutputSolutionStep()
            x, y = (
                sum(node.GetSolutionStepValue(reaction) for node in watched)
                for reaction in (Kratos.REACTION_X, Kratos.REACTION_Y)
            )
            converged = bool(converged) and math.isfinite(x + y)
            yield {
                "time": time,
                "force": [x, y],
                "iterations": part.ProcessInfo[Kratos.NL_ITERATION_NUMBER],
                "converged": converged,
            }
            if not converged:
                return

    def _InitializeInternals(self) -> None:
        solver = self._GetSolver()
        if solver.settings["contact_settings"]["adaptative_strategy"].GetBool():
            solver.AddProcessesList(self._GetListOfProcesses())
        super()._InitializeInternals()

    def _GetListOfProcesses(self) -> list[Any]:
        return [self.drive, *super()._GetListOfProcesses()]

    def _CreateSolver(self) -> Any:
        settings = self.project_parameters["solver_settings"]
        module = import_module(f"{CONTACT}.contact_structural_mechanics_static_solver")
        return module.CreateSolver(self.model, settings)

    def _GetOrderOfProcessesInitialization(self) -> list[str]:
        return ["contact_process_list"]


def _displacement(direction: int) -> Any:
    return (Kratos.DISPLACEMENT_X, Kratos.DISPLACEMENT_Y)[direction]


def start(data: ContactData, settings: dict[str, Any]) -> Analysis:
    """An analysis that is ready for its increments; files go to the working folder."""
    Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
    analysis = Analysis(settings, data)
    analysis.Initialize()
    return analysis


def main() -> int:
    file, kind, *increments = sys.argv[1:]
    data = ContactData.load(Path(file))
    good = True
    settings = parameters(data, kind)
    settings["solver_settings"]["contact_settings"]["adaptative_strategy"] = bool(data.pairs)
    for row in start(data, settings).rows([int(n) for n in increments]):
        good = row["converged"]
        sys.stdout.write(json.dumps(row) + "\n")
        sys.stdout.flush()
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
