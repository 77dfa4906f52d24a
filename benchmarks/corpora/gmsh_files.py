"""Meshes that Gmsh writes, read here, against what Gmsh itself says of them.

Run with ``python -m benchmarks gmsh_files [number]`` (default 200; needs ``gmsh``). The files go
over all versions of the format, orders, encodings, partitions, planes and group layouts. With
``--store`` some of them go to ``tests/data/gmsh`` with the counts.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import itertools
import json
import random
import sys
import tempfile
from collections import Counter
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import corota as ct
from corota.errors import CorotaError

FOLDER = Path(__file__).parents[2] / "tests" / "data" / "gmsh"
#: Kinds by Gmsh's numbers.
KINDS = {2: "tri3", 3: "quad4", 9: "tri6", 10: "quad9", 16: "quad8"}


@dataclass
class Layout:
    """How a file is made."""

    version: float
    order: int
    binary: bool
    quads: int  # 0: triangles, 1: mixed, 2: quadrilaterals
    incomplete: bool
    partitions: int
    plane: str
    groups: str  # "all", "two" for a group that overlaps another, "none"
    parametric: bool
    save_all: bool
    reverse: bool
    shape: int

    @property
    def name(self) -> str:
        """A name of it."""
        return (
            f"v{self.version}-o{self.order}-{'bin' if self.binary else 'txt'}-q{self.quads}"
            f"-i{int(self.incomplete)}-p{self.partitions}-{self.plane}-{self.groups}"
            f"-u{int(self.parametric)}-a{int(self.save_all)}-r{int(self.reverse)}-s{self.shape}"
        )


@dataclass
class Facts:
    """What a mesh is: counts by kind, group sizes, area, all in the plane of the part."""

    nodes: int = 0
    cells: dict[str, int] = field(default_factory=dict)
    surfaces: dict[str, int] = field(default_factory=dict)
    curves: dict[str, int] = field(default_factory=dict)
    curve_nodes: dict[str, int] = field(default_factory=dict)
    points: dict[str, int] = field(default_factory=dict)
    area: float = 0.0


def layouts(number: int) -> list[Layout]:
    """Layouts: every pair of version and encoding with every order first, the rest at random."""
    source = random.Random(16)
    found = []
    base = itertools.cycle(itertools.product((2.2, 4.0, 4.1), (1, 2), (False, True)))
    while len(found) < number:
        version, order, binary = next(base)
        found.append(
            Layout(
                version,
                order,
                binary and version != 4.0,  # Gmsh writes 4.0 as text only
                source.randrange(3),
                source.random() < 0.5,
                source.choice((0, 0, 0, 2, 3)),
                source.choice(("xy", "xy", "xy", "xz", "yz")),
                source.choice(("all", "all", "two", "none")),
                source.random() < 0.2,
                source.random() < 0.3,
                source.random() < 0.3,
                source.randrange(4),
            )
        )
    return found


def build(gmsh: Any, layout: Layout) -> None:
    """Mesh a part with Gmsh."""
    occ, model = gmsh.model.occ, gmsh.model
    gmsh.clear()
    model.add("part")
    first = occ.addRectangle(0.0, 0.0, 0.0, 2.0, 1.0)
    if layout.shape == 1:
        hole = occ.addDisk(1.0, 0.5, 0.0, 0.25, 0.25)
        occ.cut([(2, first)], [(2, hole)])
    elif layout.shape == 2:
        second = occ.addRectangle(2.0, 0.0, 0.0, 1.0, 1.0)
        occ.fragment([(2, first)], [(2, second)])
    elif layout.shape == 3:
        occ.addDisk(4.0, 0.5, 0.0, 0.5, 0.4)
    if layout.plane == "xz":
        occ.rotate(occ.getEntities(2), 0, 0, 0, 1, 0, 0, np.pi / 2)
    elif layout.plane == "yz":
        occ.rotate(occ.getEntities(2), 0, 0, 0, 1, 1, 1, 2 * np.pi / 3)
    occ.synchronize()
    surfaces = [tag for _, tag in model.getEntities(2)]
    curves = [tag for _, tag in model.getEntities(1)]
    if layout.groups != "none":
        model.addPhysicalGroup(2, surfaces, 7, "body")
        model.addPhysicalGroup(1, curves[:2], 3, "low side")
        model.addPhysicalGroup(1, curves[2:3], 4)
        model.addPhysicalGroup(0, [1], 2, "pin")
    if layout.groups == "two":
        model.addPhysicalGroup(2, surfaces[:1], 9, "core")
        model.addPhysicalGroup(1, curves[1:2], 8, "right")
    option = gmsh.option.setNumber
    option("Mesh.MeshSizeMin", 0.3)
    option("Mesh.MeshSizeMax", 0.3)
    option("Mesh.RecombineAll", int(layout.quads > 0))
    option("Mesh.RecombinationAlgorithm", 0 if layout.quads == 1 else 1)
    option("Mesh.Algorithm", 8 if layout.quads == 2 else 6)
    option("Mesh.SecondOrderIncomplete", int(layout.incomplete))
    option("Mesh.PartitionCreateTopology", 1)
    option("Mesh.PartitionSplitMeshFiles", 0)
    option("Mesh.SaveAll", int(layout.save_all))
    option("Mesh.SaveParametric", int(layout.parametric))
    option("Mesh.MshFileVersion", layout.version)
    option("Mesh.Binary", int(layout.binary))
    model.mesh.generate(2)
    model.mesh.setOrder(layout.order)
    if layout.partitions:
        model.mesh.partition(layout.partitions)
    if layout.reverse:
        model.mesh.reverse([(2, tag) for _, tag in model.getEntities(2)][:1])


def said(gmsh: Any) -> Facts:
    """What Gmsh says of the mesh of the file that it has just opened."""
    model, facts = gmsh.model, Facts()
    tags, xyz, _ = model.mesh.getNodes()
    place = dict(zip(tags.tolist(), xyz.reshape(-1, 3), strict=True))
    used: set[int] = set()
    cells: dict[str, dict[tuple[int, ...], None]] = {}
    for dimension, entity in model.getEntities(2):
        for kind, nodes in zip(*_elements(model, dimension, entity), strict=True):
            for row in nodes.tolist():
                cells.setdefault(KINDS[kind], {}).setdefault(tuple(row))
                used |= set(row)
    facts.cells = {kind: len(rows) for kind, rows in sorted(cells.items())}
    facts.area = _area(cells, place)
    for dimension, group in model.getPhysicalGroups():
        name = model.getPhysicalName(dimension, group) or (
            ("PhysicalPoint", "PhysicalLine", "PhysicalSurface")[dimension] + str(group)
        )
        rows: set[tuple[int, ...]] = set()
        for entity in model.getEntitiesForPhysicalGroup(dimension, group):
            for _, nodes in zip(*_elements(model, dimension, entity), strict=True):
                rows |= {tuple(row) for row in nodes.tolist()}
        own_nodes = {n for row in rows for n in row}
        if dimension == 2:
            facts.surfaces[name] = len(rows)
        elif dimension == 1:
            facts.curves[name] = len(rows)
            facts.curve_nodes[name] = len(own_nodes)
        else:
            facts.points[name] = len(own_nodes)
            used |= own_nodes
    facts.nodes = len(used)
    return facts


def _elements(model: Any, dimension: int, entity: int) -> tuple[list[int], list[np.ndarray]]:
    kinds, _, nodes = model.mesh.getElements(dimension, entity)
    sizes = [model.mesh.getElementProperties(k)[3] for k in kinds]
    return list(kinds), [n.reshape(-1, s) for n, s in zip(nodes, sizes, strict=True)]


def _area(cells: dict[str, Any], place: dict[int, np.ndarray]) -> float:
    """Sum of the areas of the corners' polygons, each positive."""
    total = 0.0
    for kind, rows in cells.items():
        corners = 3 if kind.startswith("tri") else 4
        for row in rows:
            p = np.array([place[n] for n in row[:corners]])
            normal = sum(np.cross(p[i] - p[0], p[i + 1] - p[0]) for i in range(1, corners - 1))
            total += 0.5 * float(np.linalg.norm(normal))
    return total


def read(path: Path) -> Facts:
    """The same facts of the file as it is read here; areas are negative for clockwise cells."""
    mesh = ct.mesh.read(path)
    facts = Facts(nodes=mesh.n_nodes)
    area = 0.0
    for block in sorted(mesh.cells, key=lambda b: b.kind):
        facts.cells[block.kind] = len(block)
        corners = 3 if block.kind.startswith("tri") else 4
        x, y = mesh.points[block.nodes[:, :corners]].transpose(2, 0, 1)
        area += float((0.5 * (x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum(axis=1)).sum())
    facts.area = area
    facts.surfaces = {name: len(v) for name, v in mesh.cell_sets.items()}
    facts.curves = {name: len(v) for name, v in mesh.edge_sets.items()}
    facts.curve_nodes = {n: len(v) for n, v in mesh.node_sets.items() if n in mesh.edge_sets}
    facts.points = {n: len(v) for n, v in mesh.node_sets.items() if n not in mesh.edge_sets}
    return facts


def differences(found: Facts, expected: Facts) -> list[str]:
    """What differs, in words."""
    out = [
        f"{name}: {mine} here, {theirs} by Gmsh"
        for name, mine, theirs in (
            (name, getattr(found, name), getattr(expected, name)) for name in asdict(found)
        )
        if name != "area" and mine != theirs
    ]
    if abs(found.area - expected.area) > 1e-9 * expected.area:
        out.append(f"area: {found.area} here, {expected.area} by Gmsh")
    return out


def store(kept: dict[str, Facts], folder: Path) -> None:
    """Put the smallest file of each version, order and encoding into the tests."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    groups: dict[tuple[str, ...], Path] = {}
    for name in kept:
        path = folder / f"{name}.msh"
        parts = name.split("-")
        part = "part" if parts[5] != "p0" else ""
        at = (*parts[:3], part)
        if at not in groups or path.stat().st_size < groups[at].stat().st_size:
            groups[at] = path
    facts = {}
    for path in groups.values():
        (FOLDER / path.name).write_bytes(path.read_bytes())
        facts[path.name] = asdict(kept[path.stem])
    (FOLDER / "facts.json").write_text(
        json.dumps(facts, indent=1, sort_keys=True) + "\n", encoding="utf-8"
    )


def main() -> int:
    """Print how many files agree, and each that does not."""
    try:
        import gmsh
    except (ImportError, OSError) as error:
        sys.stderr.write(f"gmsh cannot be loaded: {error} (pip install gmsh)\n")
        return 5
    numbers = [int(a) for a in sys.argv[1:] if a.isdigit()]
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    counts: Counter[str] = Counter()
    kept: dict[str, Facts] = {}
    with tempfile.TemporaryDirectory() as name:
        for layout in layouts(numbers[0] if numbers else 200):
            path = Path(name) / f"{layout.name}.msh"
            build(gmsh, layout)
            gmsh.write(str(path))
            gmsh.clear()
            gmsh.open(str(path))
            expected = said(gmsh)
            try:
                wrong = differences(read(path), expected)
            except CorotaError as error:
                wrong = [str(error)]
            counts["differ" if wrong else "agree"] += 1
            if wrong:
                print(f"{layout.name}: {'; '.join(wrong)}")
            else:
                kept[layout.name] = expected
        if "--store" in sys.argv:
            store(kept, Path(name))
    print(f"{sum(counts.values())} files: {dict(counts)}, Gmsh {gmsh.__version__}")
    gmsh.finalize()
    return int(counts["differ"] > 0)


if __name__ == "__main__":
    sys.exit(main())
