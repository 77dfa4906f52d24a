"""P1, P2, P4 with Kratos: total-Lagrangian quadrilaterals, sparse LU."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from importlib import import_module
from typing import Any

import KratosMultiphysics as Kratos
import KratosMultiphysics.LinearSolversApplication
import KratosMultiphysics.StructuralMechanicsApplication as Mechanics
from KratosMultiphysics import python_linear_solver_factory as solvers

from benchmarks.corpora.problems import Problem
from benchmarks.peers.shared import MAX_ITERATIONS, Clock, arguments, tolerance

AXES = "XY"


def material(p: Problem) -> tuple[str, dict[str, Any]]:
    """Name of the law and its variables."""
    variables: dict[str, Any] = {
        "YOUNG_MODULUS": p.young,
        "POISSON_RATIO": p.poisson,
        "THICKNESS": p.thickness,
        "DENSITY": p.density,
    }
    if not p.yield_stress:
        return "LinearElasticPlaneStress2DLaw", variables
    import_module("KratosMultiphysics.ConstitutiveLawsApplication")

    # A curve of yield stress over plastic strain, straight up to one half.
    variables |= {
        "YIELD_STRESS": p.yield_stress,
        "FRACTURE_ENERGY": 5000.0,
        "TANGENT_OPERATOR_ESTIMATION": 2,
        "HARDENING_CURVE": 6,
        "EQUIVALENT_STRESS_VECTOR_PLASTICITY_POINT_CURVE": [
            p.yield_stress,
            p.yield_stress + 0.5 * p.slope,
        ],
        "TOTAL_STRAIN_VECTOR_PLASTICITY_POINT_CURVE": [
            p.yield_stress / p.young,
            0.5 + (p.yield_stress + 0.5 * p.slope) / p.young,
        ],
    }
    return "SmallStrainIsotropicPlasticityPlaneStressVonMisesVonMises", variables


def model_part(p: Problem, model: Any) -> Any:
    """Nodes, elements, material and dofs."""
    part = model.CreateModelPart("body")
    part.SetBufferSize(3)
    part.ProcessInfo[Kratos.DOMAIN_SIZE] = 2
    for variable in (
        Kratos.DISPLACEMENT,
        Kratos.VELOCITY,
        Kratos.ACCELERATION,
        Kratos.REACTION,
        Mechanics.POINT_LOAD,
        Kratos.VOLUME_ACCELERATION,
    ):
        part.AddNodalSolutionStepVariable(variable)
    for k, (x, y) in enumerate(p.points.tolist()):
        part.CreateNewNode(k + 1, x, y, 0.0)
    properties = part.CreateNewProperties(1)
    name = f"TotalLagrangianElement2D{p.cells.shape[1]}N"
    for k, nodes in enumerate((p.cells + 1).tolist()):
        part.CreateNewElement(name, k + 1, nodes, properties)
    law, variables = material(p)
    entry = {
        "model_part_name": "body",
        "properties_id": 1,
        "Material": {"constitutive_law": {"name": law}, "Variables": variables, "Tables": {}},
    }
    reader = Kratos.ReadMaterialsUtility(model)
    reader.ReadMaterials(Kratos.Parameters(json.dumps({"properties": [entry]})))
    utility = Kratos.VariableUtils()
    utility.AddDof(Kratos.DISPLACEMENT_X, Kratos.REACTION_X, part)
    utility.AddDof(Kratos.DISPLACEMENT_Y, Kratos.REACTION_Y, part)
    for node, dof in zip(p.held_nodes.tolist(), p.held_dofs.tolist(), strict=True):
        part.Nodes[node + 1].Fix(getattr(Kratos, f"DISPLACEMENT_{AXES[dof]}"))
    for k, node in enumerate(p.load_nodes.tolist()):
        part.CreateNewCondition("PointLoadCondition2D1N", k + 1, [node + 1], properties)
    return part


def main() -> None:
    p, _ = arguments()
    Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
    model = Kratos.Model()
    part = model_part(p, model)
    transient = p.name == "P4"
    scheme = (
        Kratos.ResidualBasedBossakDisplacementScheme(0.0)
        if transient
        else Kratos.ResidualBasedIncrementalUpdateStaticScheme()
    )
    settings = {"solver_type": "LinearSolversApplication.sparse_lu"}
    builder = Kratos.ResidualBasedBlockBuilderAndSolver(
        solvers.ConstructSolver(Kratos.Parameters(json.dumps(settings)))
    )
    strategy = Kratos.ResidualBasedNewtonRaphsonStrategy(
        part,
        scheme,
        Kratos.ResidualCriteria(tolerance(p), 1e-12),
        builder,
        MAX_ITERATIONS,
        True,
        False,
        True,
    )
    strategy.SetEchoLevel(0)
    strategy.Initialize()
    moved = [
        (part.Nodes[int(n) + 1], getattr(Kratos, f"DISPLACEMENT_{AXES[d]}"), float(v))
        for n, d, v in zip(p.held_nodes, p.held_dofs, p.held_values, strict=True)
        if v != 0.0
    ]
    loaded = [
        (part.Nodes[int(n) + 1], float(v)) for n, v in zip(p.load_nodes, p.load_values, strict=True)
    ]
    watched = [part.Nodes[int(n) + 1] for n in p.watch]
    step = p.period / p.increments
    iterations, most = 0, 0.0
    clock = Clock()
    for k in range(1, p.last + 1):
        part.CloneTimeStep(k * step)
        part.ProcessInfo[Kratos.STEP] = k
        part.ProcessInfo[Kratos.DELTA_TIME] = step
        factor = 1.0 if transient else k / p.increments
        for node, variable, value in moved:
            node.SetSolutionStepValue(variable, factor * value)
        for node, value in loaded:
            node.SetSolutionStepValue(Mechanics.POINT_LOAD, [0.0, factor * value, 0.0])
        strategy.InitializeSolutionStep()
        strategy.Predict()
        if not strategy.SolveSolutionStep():
            raise SystemExit(f"increment {k} did not converge")
        strategy.FinalizeSolutionStep()
        iterations += part.ProcessInfo[Kratos.NL_ITERATION_NUMBER]
        most = max(most, watched[0].GetSolutionStepValue(Kratos.DISPLACEMENT)[1])
    if p.name == "P1":
        result = list(watched[0].GetSolutionStepValue(Kratos.DISPLACEMENT))[:2]
    elif p.name == "P2":
        result = [sum(n.GetSolutionStepValue(Kratos.REACTION_Y) for n in watched)]
    else:
        result = [most]
    clock.tell(Kratos.KratosGlobals.Kernel.Version(), iterations, result)


if __name__ == "__main__":
    main()
