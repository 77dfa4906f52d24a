"""Mechanisms of flexible bars in exudyn: geometrically exact beams, generalized alpha."""

# SPDX-License-Identifier: BSD-3-Clause
# mypy: ignore-errors
from __future__ import annotations

import numpy as np

from benchmarks.corpora.mechanisms import SAMPLES, Mechanism, measured


def run(mechanism: Mechanism, cells: int, increments: int) -> dict[str, np.ndarray]:
    """Quantities at SAMPLES equal times after the start.

    Parameters
    ----------
    mechanism : Mechanism
    cells : int
        Beams a bar, an even number.
    increments : int
        A multiple of SAMPLES.
    """
    import exudyn as exu
    from exudyn import utilities as eu

    exu.SetWriteToConsole(False)
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    ground = mbs.AddNode(eu.NodePointGround())
    on_ground = mbs.AddMarker(eu.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    nodes = []
    for bar in mechanism.bars:
        points = np.linspace(bar.start, bar.end, cells + 1)
        chord = points[-1] - points[0]
        turn = float(np.arctan2(chord[1], chord[0]))
        own = [
            mbs.AddNode(eu.NodeRigidBody2D(referenceCoordinates=[p[0], p[1], turn])) for p in points
        ]
        for pair in zip(own[:-1], own[1:], strict=True):
            beam = mbs.AddObject(
                eu.ObjectBeamGeometricallyExact2D(
                    nodeNumbers=list(pair),
                    length=bar.length / cells,
                    massPerLength=bar.mass,
                    crossSectionInertia=bar.mass * bar.ei / bar.ea,
                    bendingStiffness=bar.ei,
                    axialStiffness=bar.ea,
                    shearStiffness=bar.ga,
                    includeReferenceRotations=False,
                )
            )
            if mechanism.gravity:
                marker = mbs.AddMarker(eu.MarkerBodyMass(bodyNumber=beam))
                pull = [0.0, -mechanism.gravity, 0.0]
                mbs.AddLoad(eu.LoadMassProportional(markerNumber=marker, loadVector=pull))
        nodes.append(own)

    def dof(end, k):
        node = nodes[end[0]][-1 if end[1] else 0]
        return mbs.AddMarker(eu.MarkerNodeCoordinate(nodeNumber=node, coordinate=k))

    for end, dofs in mechanism.held:
        for d in dofs:
            markers = [on_ground, dof(end, "xy".index(d))]
            mbs.AddObject(eu.CoordinateConstraint(markerNumbers=markers))
    for one, other in mechanism.pins:
        for k in range(2):
            # Reference coordinates are the same, so displacements are.
            mbs.AddObject(eu.CoordinateConstraint(markerNumbers=[dof(one, k), dof(other, k)]))
    if mechanism.angle is not None:
        angle = mechanism.angle
        mbs.AddObject(
            eu.CoordinateConstraint(
                markerNumbers=[on_ground, dof((0, 0), 2)],
                offsetUserFunction=lambda mbs, t, number, offset: float(angle(t)),
            )
        )
    for end, mass in mechanism.masses:
        node = nodes[end[0]][-1 if end[1] else 0]
        mbs.AddObject(eu.ObjectRigidBody2D(physicsMass=mass, physicsInertia=0.0, nodeNumber=node))
    sensors = [
        [
            mbs.AddSensor(
                eu.SensorNode(
                    nodeNumber=n,
                    storeInternal=True,
                    outputVariableType=exu.OutputVariableType.Position,
                )
            )
            for n in own
        ]
        for own in nodes
    ]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = increments
    settings.timeIntegration.endTime = mechanism.period
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
    settings.timeIntegration.newton.useModifiedNewton = False
    settings.linearSolverType = exu.LinearSolverType.EigenSparse
    settings.timeIntegration.adaptiveStep = False
    settings.timeIntegration.newton.maxIterations = 50
    settings.timeIntegration.newton.relativeTolerance = 1e-8
    settings.timeIntegration.newton.absoluteTolerance = (
        1e-13 * cells * max(bar.ea for bar in mechanism.bars)
    )
    settings.timeIntegration.verboseMode = 0
    settings.displayComputationTime = False
    settings.displayStatistics = False
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = 0.5 * mechanism.period / increments
    if not mbs.SolveDynamic(settings):
        raise RuntimeError("exudyn did not solve it")
    each = increments // SAMPLES
    data = [[mbs.GetSensorStoredData(s)[::each] for s in own] for own in sensors]
    time = data[0][0][:, 0]
    expected = np.linspace(0.0, mechanism.period, SAMPLES + 1)
    if len(time) != len(expected) or np.abs(time - expected).max() > 1e-6 * mechanism.period:
        raise RuntimeError(f"exudyn wrote other times than were requested: {time}")
    x = [np.stack([d[:, 1:3] for d in own], axis=1) for own in data]
    return measured(mechanism, time, x)
