"""P1, P4 with OpenSees' corotational shell in its plane; P2 with its small-displacement quad."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from importlib.metadata import version

import openseespy.opensees as ops

from benchmarks.corpora.problems import Problem
from benchmarks.peers.shared import Clock, arguments

#: Its corotational shell converges linearly: it gets the iterations that this takes.
MAX_ITERATIONS, TOLERANCE = 500, 1e-6


def shell(p: Problem) -> None:
    """Shells with drilling rotations that stay in their plane."""
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for k, (x, y) in enumerate(p.points.tolist()):
        ops.node(k + 1, x, y, 0.0)
    ops.section("ElasticMembranePlateSection", 1, p.young, p.poisson, p.thickness, p.density)
    for k, nodes in enumerate((p.cells + 1).tolist()):
        ops.element("ASDShellQ4", k + 1, *nodes, 1, "-corotational")
    clamped = set(p.held_nodes.tolist())
    for k in range(len(p.points)):
        ops.fix(k + 1, *((1,) * 6 if k in clamped else (0, 0, 1, 1, 1, 0)))


def quad(p: Problem) -> None:
    """Plane stress with linear hardening, small displacements."""
    ops.model("basic", "-ndm", 2, "-ndf", 2)
    for k, (x, y) in enumerate(p.points.tolist()):
        ops.node(k + 1, x, y)
    shear = p.young / 2.0 / (1.0 + p.poisson)
    bulk = p.young / 3.0 / (1.0 - 2.0 * p.poisson)
    ops.nDMaterial("PlaneStressSimplifiedJ2", 1, shear, bulk, p.yield_stress, 0.0, p.slope)
    for k, nodes in enumerate((p.cells + 1).tolist()):
        ops.element("quad", k + 1, *nodes, p.thickness, "PlaneStress", 1)
    still = [
        (n, d)
        for n, d, v in zip(
            p.held_nodes.tolist(), p.held_dofs.tolist(), p.held_values.tolist(), strict=True
        )
        if v == 0.0
    ]
    for node in sorted({n for n, _ in still}):
        ops.fix(node + 1, *(int((node, d) in set(still)) for d in range(2)))


def main() -> None:
    p, _ = arguments()
    ops.wipe()
    plastic, transient = p.name == "P2", p.name == "P4"
    (quad if plastic else shell)(p)
    ops.timeSeries("Constant" if transient else "Linear", 1)
    ops.pattern("Plain", 1, 1)
    for n, d, v in zip(p.held_nodes, p.held_dofs, p.held_values, strict=True):
        if v != 0.0:
            ops.sp(int(n) + 1, int(d) + 1, float(v))
    for n, v in zip(p.load_nodes.tolist(), p.load_values.tolist(), strict=True):
        ops.load(n + 1, 0.0, v, 0.0, 0.0, 0.0, 0.0)
    # Moved nodes: with a transformation the first iteration strains one row of elements only.
    ops.constraints("Lagrange" if plastic else "Transformation")
    ops.numberer("RCM")
    ops.system("UmfPack")
    size = float(abs(p.load_values).sum())
    if plastic:
        ops.test("NormDispIncr", 1e-8, MAX_ITERATIONS, 0)
    else:
        ops.test("NormUnbalance", TOLERANCE * size, MAX_ITERATIONS, 0)
    ops.algorithm("Newton")
    if transient:
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")
    else:
        ops.integrator("LoadControl", 1.0 / p.increments)
        ops.analysis("Static")
    watched = [int(n) + 1 for n in p.watch]
    iterations, most = 0, 0.0
    clock = Clock()
    for k in range(1, p.last + 1):
        failed = ops.analyze(1, p.period / p.increments) if transient else ops.analyze(1)
        if failed:
            raise SystemExit(f"increment {k} did not converge")
        iterations += ops.testIter()
        most = max(most, ops.nodeDisp(watched[0], 2))
    if plastic:
        ops.reactions()
        result = [sum(ops.nodeReaction(n, 2) for n in watched)]
    elif transient:
        result = [most]
    else:
        result = ops.nodeDisp(watched[0])[:2]
    clock.tell(version("openseespy"), iterations, result)


if __name__ == "__main__":
    main()
