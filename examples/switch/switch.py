"""A bistable switch: two cosine flexures with a shuttle snap from one side to the other.

The part is cut from one sheet: a stiff frame (here: clamps), two parallel curved flexures and
a shuttle that prevents rotation of the middle. Pushed at the shuttle it snaps through and stays;
the path gives the push that switches it, the pull that switches it back, the second equilibrium
position and its stability.

The estimates are those of J. Qiu, J. H. Lang and A. H. Slocum, "A curved-beam bistable
mechanism", J. Microelectromech. Syst. 13 (2004) 137-146: for a clamped cosine beam of span l,
rise h and depth t with h/t well above 2.31, whose middle does not rotate, the largest push is
about 740 E I h / l^3, the largest pull back half of it, and the travel 1.99 h.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

import corota as ct

#: Half span, rise and depth of a flexure; distance of the two; half width of the shuttle [mm].
HALF, RISE, DEPTH, GAP, SHUTTLE = 25.0, 4.0, 0.5, 16.0, 3.0
#: Thickness of the sheet [mm]; nylon [MPa].
SHEET, YOUNG, POISSON = 5.0, 1800.0, 0.4


def flexure(level: float, side: int, cells: int) -> ct.Mesh:
    """Mesh half of a flexure from its clamp to the shuttle at x = 0; `side` -1 is left."""
    mesh = ct.mesh.rectangle(HALF, DEPTH, nx=cells, ny=2, cell="quad8")
    s, eta = mesh.points[:, 0] / HALF, mesh.points[:, 1] - DEPTH / 2.0
    if side > 0:
        s = 1.0 - s
    rise = RISE * 0.5 * (1.0 - np.cos(np.pi * s))
    slope = RISE * 0.5 * np.pi / HALF * np.sin(np.pi * s)
    across = np.hypot(1.0, slope)
    x = (s - 1.0) * HALF - SHUTTLE - eta * slope / across
    mesh.points = np.column_stack([-side * x, level + rise + eta / across])
    for names in (mesh.node_sets, mesh.edge_sets):
        names["clamp"] = names.pop("left" if side < 0 else "right")
        for name in ("left", "right", "bottom", "top"):
            names.pop(name, None)
    return mesh


def switch(load: float = 1.0, cells: int = 24) -> tuple[ct.Model, int]:
    """Build the part with a push of `load` downward on the shuttle, and its loaded node."""
    parts = [flexure(level, side, cells) for level in (0.0, GAP) for side in (-1, 1)]
    low = RISE - DEPTH / 2.0
    for bottom, height, rows in (
        (low, DEPTH, 2),
        (low + DEPTH, GAP - DEPTH, 8),
        (low + GAP, DEPTH, 2),
    ):
        block = ct.mesh.rectangle(2.0 * SHUTTLE, height, nx=4, ny=rows, cell="quad8")
        for names in (block.node_sets, block.edge_sets):
            names.clear()
        parts.append(ct.mesh.move(block, shift=(-SHUTTLE, bottom)))
    mesh = ct.mesh.merge(*parts)
    model = ct.Model(mesh, name="switch")
    material = ct.Elastic(E=YOUNG, nu=POISSON)
    model.section("all", element="Q8", material=material, thickness=SHEET)
    model.fix("clamp")
    top = np.array([0.0, RISE + GAP + DEPTH / 2.0])
    node = int(np.argmin(np.abs(mesh.points - top).sum(axis=1)))
    model.force([node], y=-load)
    return model, node


def estimate() -> tuple[float, float, float]:
    """Push, pull back and travel by the formulas for two flexures."""
    inertia = SHEET * DEPTH**3 / 12.0
    push = 2.0 * 740.0 * YOUNG * inertia * RISE / (2.0 * HALF) ** 3
    return push, push / 2.0, 1.99 * RISE


def follow(cells: int = 24) -> tuple[ct.Results, int]:
    """Push the shuttle through to the other side and on."""
    model, node = switch(cells=cells)
    path = ct.ArcLength(displacement=([node], "y", -2.2 * RISE))
    return ct.solve(model, ct.Static(path=path)), node


def summary(results: ct.Results, node: int) -> tuple[float, float, float]:
    """Largest push, largest pull and travel between the positions of rest."""
    limits = [p.factor for p in results.critical_points if p.kind == "limit"]
    factor = results.history("load factor").values
    moved = -results.history("U2", at=[node]).values
    # The last sign change of the load is the other position of rest.
    last = int(np.flatnonzero(factor[:-1] * factor[1:] < 0.0)[-1])
    share = factor[last] / (factor[last] - factor[last + 1])
    travel = moved[last] + share * (moved[last + 1] - moved[last])
    return max(limits), -min(limits), float(travel)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pictures", type=Path, help="folder for the path and its animation")
    args = parser.parse_args()
    results, node = follow()
    for point in results.critical_points:
        sys.stdout.write(f"{point}\n")
    names = ("push to switch [N]", "pull back [N]", "travel [mm]")
    for name, found, rough in zip(names, summary(results, node), estimate(), strict=True):
        sys.stdout.write(f"{name:20}{found:10.4f}   estimate {rough:.4f}\n")
    if args.pictures:
        results.history("U2", at=[node]).plot("load factor", path=args.pictures / "switch.png")
        from corota import plots

        plots.animate(results, "MISES", path=args.pictures / "switch.gif")


if __name__ == "__main__":
    main()
