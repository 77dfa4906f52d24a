"""What the audits share: decks, tables and small reference programs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from corota.mesh.data import Cells

CELL = {
    "T3": "tri3",
    "OPT": "tri3",
    "T6": "tri6",
    "Q4": "quad4",
    "Q4I": "quad4",
    "Q4R": "quad4",
    "Q4S": "quad4",
    "Q4D": "quad4",
    "Q4DI": "quad4",
    "Q8": "quad8",
    "Q8R": "quad8",
    "Q9": "quad9",
}
DRILLING = ("OPT", "Q4D", "Q4DI")


def rotation(angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]])


def boundary(mesh: Any) -> np.ndarray:
    return np.unique(np.concatenate([mesh.nodes_of(s) for s in ("left", "right", "top", "bottom")]))


def run(path: Path, text: str, **options: Any) -> Any:
    """Run a deck and leave its files beside it."""
    path.write_text(text)
    model = ct.read(path, **options)
    files = ct.JobFiles(path.parent, path.stem, points=True)
    return ct.solve(model, observers=[files], threads=1)


def deck_mesh(mesh: Any, kind: str) -> str:
    """Nodes, elements and sets of a mesh of one kind of cell as cards."""
    lines = ["*NODE"]
    for label, (x, y) in zip(mesh.node_labels, mesh.points, strict=True):
        lines.append(f"{label}, {float(x)!r}, {float(y)!r}")
    lines.append(f"*ELEMENT, TYPE={kind}, ELSET=all")
    for label, nodes in zip(mesh.cells[0].labels, mesh.cells[0].nodes, strict=True):
        lines.append(f"{label}, " + ", ".join(str(mesh.node_labels[n]) for n in nodes))
    for name in ("left", "right", "top", "bottom"):
        lines.append(f"*NSET, NSET={name}")
        lines += [str(mesh.node_labels[n]) for n in mesh.nodes_of(name)]
    return "\n".join(lines) + "\n"


def ends(results: Any) -> list[Any]:
    """Last frame of each step."""
    last = {f.step: f for f in results.frames}
    return [last[k] for k in sorted(last)]


def radial_return(
    e: np.ndarray, state: dict[str, np.ndarray], m: dict[str, float]
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """J2 return map in principal directions: strain (n, 3) to stress (n, 3), linear hardenings.

    `m` has E, nu, sy, H (isotropic slope), K (kinematic modulus).
    """
    G, bulk = m["E"] / (2 + 2 * m["nu"]), m["E"] / (3 - 6 * m["nu"])
    ee = e - state["ep"]
    mean = ee.sum(axis=1, keepdims=True) / 3
    s = 2 * G * (ee - mean)
    xi = s - state["beta"]
    q = np.sqrt(1.5) * np.linalg.norm(xi, axis=1, keepdims=True)
    dp = np.maximum(0.0, (q - m["sy"] - m["H"] * state["p"]) / (3 * G + m["H"] + m["K"]))
    flow = 1.5 * xi / np.maximum(q, 1e-300)
    new = {
        "ep": state["ep"] + dp * flow,
        "beta": state["beta"] + 2 / 3 * m["K"] * dp * flow,
        "p": state["p"] + dp,
    }
    return s - 2 * G * dp * flow + 3 * bulk * mean, new


def virgin(n: int) -> dict[str, np.ndarray]:
    return {"ep": np.zeros((n, 3)), "beta": np.zeros((n, 3)), "p": np.zeros((n, 1))}


class Bar:
    """One-dimensional elastic-plastic fibers with linear isotropic and kinematic hardening."""

    def __init__(self, n: int, E: float, sy: float, H: float = 0.0, K: float = 0.0) -> None:
        self.E, self.sy, self.H, self.K = E, sy, H, K
        self.ep, self.beta, self.p = np.zeros(n), np.zeros(n), np.zeros(n)

    def stress(self, e: np.ndarray, commit: bool = False) -> np.ndarray:
        s = self.E * (e - self.ep)
        xi = s - self.beta
        dp = np.maximum(0, np.abs(xi) - self.sy - self.H * self.p) / (self.E + self.H + self.K)
        flow = np.sign(xi) * dp
        if commit:
            self.ep, self.beta = self.ep + flow, self.beta + self.K * flow
            self.p = self.p + dp
        return s - self.E * flow


def tables(path: Path) -> dict[str, list[np.ndarray]]:
    """Read the tables of a .dat file: rows of numbers below each heading, by its first word."""
    found: dict[str, list[np.ndarray]] = {}
    rows: list[list[float]] = []
    head = ""
    for line in [*path.read_text().splitlines(), "end"]:
        words = line.split()
        if not words:
            continue
        try:
            rows.append([float(w) for w in words])
        except ValueError:
            if rows:
                found.setdefault(head, []).append(np.array(rows))
            rows, head = [], line.strip().split(" for ")[0].split(" (")[0]
    return found


BARS = """*NODE
1, 0., 0.
2, 2., 0.
3, 4., 0.
*ELEMENT, TYPE=T2D2, ELSET=all
1, 1, 2
2, 2, 3
*NSET, NSET=ends
1
*MATERIAL, NAME=m
*ELASTIC
100., 0.
*DENSITY
0.5
*EXPANSION
1e-3
*SOLID SECTION, ELSET=all, MATERIAL=m
0.2
*AMPLITUDE, NAME=tri
0., 0., 0.5, 1., 1., 0.4
*AMPLITUDE, NAME=tot, TIME=TOTAL TIME
0., 0., 1., 1., 3., -1.
*BOUNDARY
1, 1, 2
2, 2, 2
3, 2, 2
"""


def line_mesh(points: np.ndarray, pairs: list[tuple[int, int]]) -> Any:
    from corota.mesh import Mesh

    cells = [Cells("line2", np.array(pairs), np.arange(1, len(pairs) + 1))]
    return Mesh(np.asarray(points, float), cells, np.arange(1, len(points) + 1))


def rows_of(path: Path, head: str) -> list[list[str]]:
    """Rows of text below each heading of a .dat file."""
    found: list[list[str]] = []
    for line in path.read_text().splitlines():
        if line.strip().startswith(head):
            found.append([])
        elif found and line[:10].strip().isdigit():
            found[-1].append(line)
    return found
