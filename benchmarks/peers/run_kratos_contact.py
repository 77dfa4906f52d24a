"""P3 with Kratos: mortar contact by augmented Lagrange multipliers, sparse LU."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from importlib import import_module
from pathlib import Path
from typing import Any

import KratosMultiphysics as Kratos
import numpy as np
from KratosMultiphysics.StructuralMechanicsApplication import structural_mechanics_analysis

from benchmarks.peers.shared import MAX_ITERATIONS, TOLERANCE, Clock, arguments
from benchmarks.problems import Problem

CONTACT = "KratosMultiphysics.ContactStructuralMechanicsApplication"


def write_mesh(p: Problem) -> None:
    """Write ``job.mdpa`` with the parts that the contact process asks for."""
    lines = ["Begin Properties 0", "End Properties", "Begin Properties 1", "End Properties"]
    lines.append("Begin Nodes")
    lines += [f"{k + 1} {x:.12g} {y:.12g} 0.0" for k, (x, y) in enumerate(p.points.tolist())]
    lines += ["End Nodes", "Begin Elements TotalLagrangianElement2D4N"]
    lines += [f"{k + 1} 1 {' '.join(map(str, c))}" for k, c in enumerate((p.cells + 1).tolist())]
    lines += ["End Elements", "Begin Conditions LineCondition2D2N"]
    edges = np.concatenate([p.slave, p.master]) + 1
    lines += [f"{k + 1} 1 {a} {b}" for k, (a, b) in enumerate(edges.tolist())]
    lines.append("End Conditions")
    moved = p.held_nodes[p.held_values != 0.0]
    still = np.setdiff1d(p.held_nodes, moved)
    slave, both = range(1, len(p.slave) + 1), range(1, len(edges) + 1)
    parts: dict[str, tuple[Any, Any, Any]] = {
        "All": (range(len(p.points)), range(1, len(p.cells) + 1), ()),
        "Top": (np.unique(moved), (), ()),
        "Bottom": (np.unique(still), (), ()),
        "ContactTerm": (np.unique(edges - 1), (), both),
        "Slave": (np.unique(p.slave), (), slave),
        "Master": (np.unique(p.master), (), range(len(p.slave) + 1, len(edges) + 1)),
    }
    for name, (nodes, elements, conditions) in parts.items():
        lines.append(f"Begin SubModelPart {name}")
        for kind, numbers in (
            ("Nodes", [int(n) + 1 for n in nodes]),
            ("Elements", elements),
            ("Conditions", conditions),
        ):
            if len(numbers):
                lines.append(f"Begin SubModelPart{kind}")
                lines += [str(n) for n in numbers]
                lines.append(f"End SubModelPart{kind}")
        lines.append("End SubModelPart")
    Path("job.mdpa").write_text("\n".join(lines) + "\n", encoding="ascii")


def parameters(p: Problem) -> dict[str, Any]:
    """Settings of the analysis."""
    law = {
        "constitutive_law": {"name": "LinearElasticPlaneStress2DLaw"},
        "Variables": {
            "YOUNG_MODULUS": p.young,
            "POISSON_RATIO": p.poisson,
            "THICKNESS": p.thickness,
            "DENSITY": 1.0,
        },
        "Tables": {},
    }
    entry = {"model_part_name": "Structure.All", "properties_id": 1, "Material": law}
    Path("material.json").write_text(json.dumps({"properties": [entry]}), encoding="ascii")

    def hold(part: str, y: object) -> dict[str, Any]:
        return {
            "python_module": "assign_vector_variable_process",
            "kratos_module": "KratosMultiphysics",
            "process_name": "AssignVectorVariableProcess",
            "Parameters": {
                "model_part_name": f"Structure.{part}",
                "variable_name": "DISPLACEMENT",
                "constrained": [True, True, False],
                "value": [0.0, y, 0.0],
                "interval": [0.0, "End"],
            },
        }

    kind = "Frictional" if p.friction else "Frictionless"
    contact: dict[str, Any] = {
        "model_part_name": "Structure",
        "assume_master_slave": {"0": ["Slave"]},
        "contact_model_part": {"0": ["ContactTerm"]},
        "contact_type": kind,
    }
    if p.friction:
        contact["friction_coefficients"] = {"0": p.friction}
    end = p.last / p.increments
    down = float(p.held_values.min())
    return {
        "problem_data": {
            "problem_name": "job",
            "parallel_type": "OpenMP",
            "start_time": 0.0,
            "end_time": end * (1.0 - 1e-6),
            "echo_level": 0,
        },
        "solver_settings": {
            "model_part_name": "Structure",
            "domain_size": 2,
            "solver_type": "Static",
            "echo_level": 0,
            "analysis_type": "non_linear",
            "model_import_settings": {"input_type": "mdpa", "input_filename": "job"},
            "material_import_settings": {"materials_filename": "material.json"},
            "contact_settings": {"mortar_type": f"ALMContact{kind}"},
            "clear_storage": False,
            "reform_dofs_at_each_step": False,
            "time_stepping": {"time_step": 1.0 / p.increments},
            "convergence_criterion": "contact_residual_criterion",
            "residual_relative_tolerance": TOLERANCE,
            "residual_absolute_tolerance": 1e-10,
            "max_iteration": MAX_ITERATIONS,
            "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"},
        },
        "processes": {
            "constraints_process_list": [hold("Bottom", 0.0), hold("Top", f"{down}*t")],
            "contact_process_list": [
                {
                    "python_module": "alm_contact_process",
                    "kratos_module": CONTACT,
                    "process_name": "contact",
                    "Parameters": contact,
                }
            ],
        },
    }


class Analysis(structural_mechanics_analysis.StructuralMechanicsAnalysis):
    """Counts iterations and sums the reactions of the moved side."""

    iterations, reaction = 0, 0.0

    def _CreateSolver(self) -> Any:
        module = import_module(f"{CONTACT}.contact_structural_mechanics_static_solver")
        return module.CreateSolver(self.model, self.project_parameters["solver_settings"])

    def FinalizeSolutionStep(self) -> None:
        super().FinalizeSolutionStep()
        info = self.model["Structure"].ProcessInfo
        if info[Kratos.NL_ITERATION_NUMBER] >= MAX_ITERATIONS:
            raise SystemExit(f"time {info[Kratos.TIME]:g} did not converge")
        self.iterations += info[Kratos.NL_ITERATION_NUMBER]
        nodes = self.model["Structure.Top"].Nodes
        self.reaction = sum(n.GetSolutionStepValue(Kratos.REACTION_Y) for n in nodes)

    def _GetOrderOfProcessesInitialization(self) -> list[str]:
        return ["constraints_process_list", "contact_process_list"]


def main() -> None:
    p, _ = arguments()
    Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
    write_mesh(p)
    analysis = Analysis(Kratos.Model(), Kratos.Parameters(json.dumps(parameters(p))))
    analysis.Initialize()
    clock = Clock()
    analysis.RunSolutionLoop()
    clock.tell(Kratos.KratosGlobals.Kernel.Version(), analysis.iterations, [analysis.reaction])


if __name__ == "__main__":
    main()
