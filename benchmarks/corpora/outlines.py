"""Corpus of outlines: drawings in the dialects of CAD programs, meshed and counted.

Each drawing's mesh is compared with the exact outline: nodes of the boundary on its curves, area,
length of each set, number of loops, parts. Drawings with faults must be refused with a reason.
``python -m benchmarks outlines --draw meshes`` also draws one mesh of each shape.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import math
import tempfile
import time
from pathlib import Path

import numpy as np

import corota as ct
from benchmarks.common import table
from benchmarks.corpora.outline_drawings import CORPUS, DIALECTS, ENDINGS, REFUSED, SHAPES, Shape
from corota.errors import InputError
from corota.mesh.quality import corner_angles

#: Cells around a circle, to which areas and lengths of arcs are exact.
AROUND = 24
#: Distance of boundary nodes from the exact outline, relative to its size; arcs that a drawing has
#: as splines through 25 points are no exact arcs.
NEAR = {"splines": 5e-4}
NEAR_OTHERS = 2e-6


def boundary(mesh: ct.Mesh) -> np.ndarray:
    """Sides of one cell only, shape (n, 2)."""
    sides: dict[tuple[int, int], int] = {}
    for block in mesh.cells:
        for cell in block.nodes.tolist():
            for a, b in zip(cell, [*cell[1:], cell[0]], strict=True):
                key = (min(a, b), max(a, b))
                sides[key] = sides.get(key, 0) + 1
    return np.array([side for side, count in sides.items() if count == 1])


def covered(mesh: ct.Mesh) -> float:
    """Area of the cells."""
    total = 0.0
    for block in mesh.cells:
        corners = mesh.points[block.nodes[:, : 3 if block.kind.startswith("tri") else 4]]
        x, y = corners[..., 0], corners[..., 1]
        total += 0.5 * (x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum()
    return total


def count_loops(mesh: ct.Mesh, sides: np.ndarray) -> int:
    """Closed loops of the boundary."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(len(sides)), sides.T), shape=(mesh.n_nodes,) * 2)
    _, owner = connected_components(graph, directed=False)
    return len(np.unique(owner[sides]))


def distance(shape: Shape, points: np.ndarray) -> float:
    """Largest distance of points from the exact outline [length]."""
    nearest = np.full(len(points), np.inf)
    for piece, _ in (p for loop in shape.loops for p in loop):
        if piece[0] == "line":
            a, b = (np.array(p, dtype=float) for p in piece[1:])
            share = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
            apart = np.hypot(*(points - a - share[:, None] * (b - a)).T)
        else:
            _, center, r, first, last = piece
            out = points - np.array(center)
            angle = np.arctan2(out[:, 1], out[:, 0])
            low, high = sorted((first, last))
            turn = (angle - low + 1e-4) % (2.0 * math.pi)
            apart = np.where(turn <= high - low + 2e-4, np.abs(np.hypot(*out.T) - r), np.inf)
        nearest = np.minimum(nearest, apart)
    return float(nearest.max())


def placed(dialect: str, points: np.ndarray) -> np.ndarray:
    """Points of a mesh in the axes of its shape: two dialects move the part."""
    if dialect == "block":
        c, s = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
        return (points - (7.0, -3.0)) @ np.array([[c, -s], [s, c]]) * (-1.0, 1.0)
    if dialect == "vector":
        return points * (1.0, -1.0) - (3.0, -2.0)
    return points


def check(name: str, dialect: str, folder: Path) -> tuple[ct.Mesh, dict[str, float], list[str]]:
    """Mesh a drawing of the corpus; its figures, and what is wrong.

    Parameters
    ----------
    name, dialect : str
    folder : Path
        For the drawing.
    """
    shape = SHAPES[name]
    path = folder / f"{name}-{dialect}{ENDINGS.get(dialect, '.dxf')}"
    DIALECTS[dialect](shape, path, np.random.default_rng(5))
    start = time.perf_counter()
    mesh = ct.mesh.outline(path, through=4)
    seconds = time.perf_counter() - start
    sides = boundary(mesh)
    size = float(np.hypot(*np.ptp(mesh.points, axis=0)))
    lengths = {
        layer: sum(math.dist(*mesh.points[nodes[:2]]) for nodes in mesh.edge_nodes(edges))
        for layer, edges in mesh.edge_sets.items()
    }
    layered = dialect != "solid"
    wanted = shape.lengths if layered else {"all": sum(shape.lengths.values())}
    found = lengths if layered else {"all": sum(lengths.values())}
    angles = np.concatenate(
        [corner_angles(c.kind, mesh.points[c.nodes]).ravel() for c in mesh.cells]
    )
    figures = {
        "cells": mesh.n_cells,
        "quadrilaterals": sum(len(c) for c in mesh.cells if c.kind == "quad4") / mesh.n_cells,
        "least": float(angles.min()),
        "most": float(angles.max()),
        "off": distance(shape, placed(dialect, mesh.points[np.unique(sides)])) / size,
        "area": covered(mesh) / shape.area - 1.0,
        "length": max(abs(found.get(k, 0.0) / v - 1.0) for k, v in wanted.items()),
        "loops": count_loops(mesh, sides),
        "seconds": seconds,
    }
    # Chords of a 24th of a circle are short by 0.3 %, and a segment of the disc by 1.1 %.
    chord = 1.0 - math.sin(math.pi / AROUND) / (math.pi / AROUND)
    near = NEAR.get(dialect, NEAR_OTHERS)
    wrong = [
        text
        for right, text in (
            (figures["off"] <= near, "boundary nodes off the outline"),
            (abs(figures["area"]) <= 4.0 * chord, "area"),
            (set(found) == set(wanted), f"sets {sorted(found)}"),
            (figures["length"] <= 1.1 * chord + near, "length of a set"),
            (figures["loops"] == len(shape.loops), "loops"),
            (len(mesh.cell_sets) == shape.parts, "parts"),
            (figures["least"] > 15.0 and figures["most"] < 165.0, "a corner of a cell"),
        )
        if not right
    ]
    return mesh, figures, wrong


def draw(mesh: ct.Mesh, path: Path, title: str) -> None:
    """Draw the cells and the sets of a mesh."""
    import matplotlib.pyplot as plt
    from matplotlib.collections import LineCollection, PolyCollection

    figure, ax = plt.subplots(figsize=(11, 8), layout="constrained")
    for block in mesh.cells:
        shade = "#e4ecf4" if block.kind.startswith("quad") else "#f4b183"
        ax.add_collection(PolyCollection(mesh.points[block.nodes], facecolor=shade,
                                         edgecolor="#5a6b7b", linewidth=0.5))  # fmt: skip
    for k, edges in enumerate(mesh.edge_sets.values()):
        lines = mesh.points[[n[:2] for n in mesh.edge_nodes(edges)]]
        ax.add_collection(LineCollection(lines, colors=[f"C{k}"], linewidths=1.6))
    ax.autoscale()
    ax.set_aspect("equal")
    ax.set_title(title)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main(words: list[str] | None = None) -> int:
    """Run the corpus; the number of faults."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="shape or dialect")
    parser.add_argument("--draw", type=Path, help="folder for a picture of each shape")
    args = parser.parse_args(words)
    rows, faults, drawn = [], 0, set()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for shape, dialect in CORPUS:
            if args.only not in ("", shape, dialect):
                continue
            try:
                mesh, f, wrong = check(shape, dialect, folder)
            except (InputError, ValueError) as error:
                rows.append([shape, dialect, *[""] * 8, f"refused: {error}"])
                faults += 1
                continue
            faults += bool(wrong)
            rows.append([shape, dialect, f"{f['cells']:.0f}", f"{100 * f['quadrilaterals']:.1f}",
                         f"{f['least']:.0f}-{f['most']:.0f}", f"{f['off']:.0e}",
                         f"{100 * f['area']:+.2f}", f"{100 * f['length']:.2f}",
                         f"{f['loops']:.0f}", f"{f['seconds']:.2f}",
                         "; ".join(wrong) or "right"])  # fmt: skip
            if args.draw and shape not in drawn:
                drawn.add(shape)
                args.draw.mkdir(parents=True, exist_ok=True)
                draw(mesh, args.draw / f"{shape}.png", f"{shape}, {dialect}: {mesh.notes[-1]}")
        print(table(["shape", "dialect", "cells", "quads %", "corners", "off / size", "area %",
                     "length %", "loops", "s", ""], rows))  # fmt: skip
        refusals = []
        for case, (write, _) in REFUSED.items():
            write(folder / f"{case}.dxf")
            try:
                ct.mesh.outline(folder / f"{case}.dxf")
            except InputError as error:
                refusals.append([case, str(error)])
            else:
                refusals.append([case, "taken, which is wrong"])
                faults += 1
        print(table(["fault", "reason"], refusals))
    print(f"{len(CORPUS)} outlines and {len(REFUSED)} with faults: {faults} not as they should be")
    return faults


if __name__ == "__main__":
    raise SystemExit(min(main(), 1))
