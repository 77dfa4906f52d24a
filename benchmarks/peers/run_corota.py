"""P1 to P4 with Corota. Options: element, strain, scheme, method (of contact), threads."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings

import numpy as np

import corota as ct
import corota.analysis.run  # imported by the first solution otherwise, inside its time
from benchmarks.corpora.problems import Problem
from benchmarks.peers.shared import Clock, arguments
from corota.mesh import Cells


def model_of(p: Problem, element: str, strain: str, method: str = "mortar") -> ct.Model:
    """Corota's model of a problem; those with drilling rotations hold them where clamped."""
    kind = {3: "tri3", 4: "quad4", 8: "quad8"}[p.cells.shape[1]]
    model = ct.Model(ct.Mesh(p.points, [Cells(kind, p.cells, np.arange(1, len(p.cells) + 1))]))
    material: ct.model.materials.Material = ct.Elastic(E=p.young, nu=p.poisson, rho=p.density)
    if p.yield_stress:
        material = ct.Mises(
            E=p.young, nu=p.poisson, yield_stress=p.yield_stress, isotropic=p.slope, rho=p.density
        )
    model.section(
        "all", element=element, material=material, thickness=p.thickness, local_strain=strain
    )
    if len(p.slave):
        slave, master = (model.mesh.edges_between(ends) for ends in (p.slave, p.master))
        model.contact(slave, master, method=method, friction=p.friction)
    for node, dof, value in zip(p.held_nodes, p.held_dofs, p.held_values, strict=True):
        x, y = (value, None) if dof == 0 else (None, value)
        model.fix([node], x=x, y=y)
    for node, dof, value in zip(p.load_nodes, p.load_dofs, p.load_values, strict=True):
        model.force([node], **{"xy"[dof]: value})
    return model


def main() -> None:
    p, options = arguments()
    element = options.get("element", "Q4")
    model = model_of(
        p, element, options.get("strain", "green_lagrange"), options.get("method", "mortar")
    )
    share = p.last / p.increments
    step: ct.Static | ct.Dynamic
    if p.name == "P4":
        step = ct.Dynamic(
            period=p.period * share,
            increments=p.last,
            mass="constant",
            scheme=options.get("scheme", "newmark"),
        )
    else:
        # Amplitudes and ramps end at the whole load: run a share of it as a step of its own.
        for support in model.supports:
            support.value *= share
        for load in model.loads:
            load.value *= share
        step = ct.Static(increments=p.last)
    warnings.simplefilter("ignore")
    clock = Clock()
    results = ct.solve(model, step, threads=int(options.get("threads", "1")), fields=False)
    frame = results.frames[-1]
    if p.name == "P1":
        result = list(frame.U[p.watch[0]])
    elif p.name in ("P2", "P3"):
        result = [frame.RF[p.watch, 1].sum()]
    else:
        result = [max(float(f.U[p.watch[0], 1]) for f in results.frames)]
    clock.tell(
        ct.__version__,
        results.info["iterations"],
        result,
        profile=results.info["profile"],
        increments=len(results.frames) - 1,
    )


if __name__ == "__main__":
    main()
