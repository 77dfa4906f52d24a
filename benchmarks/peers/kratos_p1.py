"""P1 with Kratos: total-Lagrangian quadrilaterals, sparse LU. Arguments: n, tolerance."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
import sys
import time

import KratosMultiphysics as Kratos
import KratosMultiphysics.LinearSolversApplication
import KratosMultiphysics.StructuralMechanicsApplication as Mechanics
from KratosMultiphysics import python_linear_solver_factory as solvers

from benchmarks import cantilever as p1


def main() -> None:
    n, tolerance = int(sys.argv[1]), float(sys.argv[2])
    Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)
    start = time.perf_counter()
    points, cells = p1.grid(n)
    model = Kratos.Model()
    part = model.CreateModelPart("cantilever")
    part.SetBufferSize(2)
    part.ProcessInfo[Kratos.DOMAIN_SIZE] = 2
    for variable in (
        Kratos.DISPLACEMENT,
        Kratos.REACTION,
        Mechanics.POINT_LOAD,
        Kratos.VOLUME_ACCELERATION,
    ):
        part.AddNodalSolutionStepVariable(variable)
    for k, (x, y) in enumerate(points.tolist()):
        part.CreateNewNode(k + 1, x, y, 0.0)
    properties = part.CreateNewProperties(1)
    for k, nodes in enumerate((cells + 1).tolist()):
        part.CreateNewElement("TotalLagrangianElement2D4N", k + 1, nodes, properties)
    material = {
        "constitutive_law": {"name": "LinearElasticPlaneStress2DLaw"},
        "Variables": {
            "YOUNG_MODULUS": p1.YOUNG,
            "POISSON_RATIO": p1.POISSON,
            "THICKNESS": p1.THICKNESS,
            "DENSITY": 1.0,
        },
        "Tables": {},
    }
    entry = {"model_part_name": "cantilever", "properties_id": 1, "Material": material}
    reader = Kratos.ReadMaterialsUtility(model)
    reader.ReadMaterials(Kratos.Parameters(json.dumps({"properties": [entry]})))
    utility = Kratos.VariableUtils()
    utility.AddDof(Kratos.DISPLACEMENT_X, Kratos.REACTION_X, part)
    utility.AddDof(Kratos.DISPLACEMENT_Y, Kratos.REACTION_Y, part)
    for node in part.Nodes:
        if node.X == 0.0:
            node.Fix(Kratos.DISPLACEMENT_X)
            node.Fix(Kratos.DISPLACEMENT_Y)
    shares = p1.tip_shares(points)
    for k, node in enumerate(shares):
        part.CreateNewCondition("PointLoadCondition2D1N", k + 1, [node + 1], properties)
    settings = {"solver_type": "LinearSolversApplication.sparse_lu"}
    strategy = Kratos.ResidualBasedNewtonRaphsonStrategy(
        part,
        Kratos.ResidualBasedIncrementalUpdateStaticScheme(),
        Kratos.ResidualCriteria(tolerance, 1e-12),
        Kratos.ResidualBasedBlockBuilderAndSolver(
            solvers.ConstructSolver(Kratos.Parameters(json.dumps(settings)))
        ),
        50,
        True,
        False,
        True,
    )
    strategy.SetEchoLevel(0)
    strategy.Initialize()
    ready = time.perf_counter()
    iterations = 0
    for k in range(1, p1.INCREMENTS + 1):
        part.CloneTimeStep(k / p1.INCREMENTS)
        part.ProcessInfo[Kratos.STEP] = k
        for node, share in shares.items():
            force = p1.SHEAR * p1.THICKNESS * share * k / p1.INCREMENTS
            part.Nodes[node + 1].SetSolutionStepValue(Mechanics.POINT_LOAD, [0.0, force, 0.0])
        strategy.InitializeSolutionStep()
        strategy.Predict()
        if not strategy.SolveSolutionStep():
            raise SystemExit(f"increment {k} did not converge")
        strategy.FinalizeSolutionStep()
        iterations += part.ProcessInfo[Kratos.NL_ITERATION_NUMBER]
    done = time.perf_counter()
    tip = part.Nodes[p1.tip_middle(points) + 1].GetSolutionStepValue(Kratos.DISPLACEMENT)
    result = {"setup": ready - start, "solve": done - ready, "iterations": iterations}
    sys.stdout.write(json.dumps({**result, "u": tip[0], "v": tip[1]}) + "\n")


if __name__ == "__main__":
    main()
