"""Meshes of outlines by Gmsh: quadrilaterals, sizes by curvature and by the local thickness."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re
import tempfile
from itertools import pairwise
from pathlib import Path
from shutil import copyfile
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from corota.errors import FileError, InputError, ResourceError
from corota.io.gmsh.reader import read_gmsh
from corota.mesh.quality import corner_sines
from corota.outline.curves import Curve
from corota.outline.loops import Loops, clean, contains

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable
    from os import PathLike

    from numpy.typing import NDArray

    from corota.mesh.data import Mesh

    Floats = NDArray[np.float64]

#: Largest cell relative to the diagonal of the outline, where no size is given.
SIZE = 0.03
#: Cells along a full circle.
AROUND = 24
#: Length over thickness from which a part with four sides is meshed in rows, and the largest length
#: of its cells over their height.
SLENDER, ASPECT = 4.0, 5.0
#: Growth of the cell size with the distance from a place of small cells.
GROWTH = 0.25
#: Numbers of Gmsh: frontal quadrilaterals, blossom recombination.
ALGORITHM, RECOMBINATION = 8, 1
#: Formats that Gmsh's geometry kernel reads.
SOLIDS = (".step", ".stp", ".iges", ".igs", ".brep")


def outline(
    source: str | PathLike[str] | Iterable[Curve],
    size: float = 0.0,
    *,
    through: int = 4,
    triangles: bool = False,
    quadratic: bool = False,
    gap: float = 0.0,
    layers: Collection[str] = (),
    path: str | PathLike[str] | None = None,
) -> Mesh:
    """Mesh the part or parts within an outline.

    Parameters
    ----------
    source : path-like or iterable of Curve
        A drawing (``.dxf``), a face (``.step``, ``.iges``, ``.brep``), or curves
        (:mod:`corota.outline.curves`). Closed curves are parts; those within a part are holes.
    size : float
        Largest side of a cell [length]; 3 % of the diagonal by default.
    through : int
        Cells across the local thickness, at least.
    triangles, quadratic : bool
        Kind of cells; linear quadrilaterals by default, with single triangles where needed.
    gap : float
        Largest gap between ends of curves that is closed [length]; 1e-5 of the diagonal by default.
    layers : collection of str
        Layers of a drawing that are taken; all by default.
    path : path-like, optional
        Also keep the mesh as Gmsh wrote it (``.msh``).

    Returns
    -------
    Mesh
        Edge sets by layer or color of the curves; cell sets ``part``, or ``part_1`` ..., or the
        text that stands in a part. ``notes`` says what was cleaned, the unit, and the sharpest
        corner of a cell.

    Raises
    ------
    InputError
        If the outline is open or crosses itself, with the places.
    FileError
        If the file is not readable.
    ResourceError
        If Gmsh, or ezdxf for a drawing, is not installed.
    """
    if size < 0.0 or through < 1:
        raise InputError(f"size must be >= 0 and through >= 1, not {size} and {through}")
    gmsh = _gmsh()
    notes: list[str] = []
    texts: list[tuple[str, tuple[float, float]]] = []
    kind = "" if not isinstance(source, (str, Path)) else Path(source).suffix.lower()
    if kind == ".dxf":
        from corota.outline.dxf import read_dxf

        curves, texts, unit, notes = read_dxf(Path(str(source)), layers)
        notes += [f"unit of the drawing: {unit}"] if unit else []
    elif kind and kind not in SOLIDS:
        raise InputError(
            f"{source}: outlines are read from .dxf, {', '.join(SOLIDS)}; a mesh is read by "
            "corota.mesh.read"
        )
    elif not kind:
        curves = []
        for each in cast("Iterable[Curve | list[Curve]]", source):
            curves += each if isinstance(each, list) else [each]
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.add("outline")
        if kind in SOLIDS:
            sizes = _import(gmsh, Path(str(source)), size)
        else:
            loops = clean(curves, gap)
            notes = [*loops.report, *notes]
            _build(gmsh, loops, texts, size, through)
            sizes = _sizes(loops, size, through)
        mesh = _mesh(gmsh, sizes, triangles, quadratic, path)
    except Exception as error:
        if isinstance(error, (InputError, FileError, ResourceError)):
            raise
        raise InputError(f"Gmsh could not mesh the outline: {error}") from None
    finally:
        gmsh.finalize()
    worst = min(float(corner_sines(c.kind, mesh.points[c.nodes]).min()) for c in mesh.cells)
    angle = np.degrees(np.arcsin(np.clip(worst, -1.0, 1.0)))
    counts = ", ".join(f"{len(c):,} {c.kind}" for c in mesh.cells)
    mesh.notes = [*notes, f"{mesh.n_nodes:,} nodes, {counts}; sharpest corner {angle:.0f} degrees"]
    return mesh


def _gmsh() -> Any:
    try:
        import gmsh
    except (ImportError, OSError) as error:
        raise ResourceError(
            f"outlines are meshed by Gmsh, which is not installed ({error}): "
            "pip install corota[mesh]"
        ) from None
    return gmsh


def _build(
    gmsh: Any,
    loops: Loops,
    texts: list[tuple[str, tuple[float, float]]],
    size: float,
    through: int,
) -> None:
    """Give the loops to Gmsh, with a physical group for each name; strips are structured."""
    geo = gmsh.model.geo
    corner = [geo.addPoint(x, y, 0.0) for x, y in loops.points]
    tags: list[int] = []
    groups: dict[str, list[int]] = {}
    for curve, (a, b) in zip(loops.curves, loops.ends.tolist(), strict=True):
        if curve.center is not None:
            center = geo.addPoint(*curve.center, 0.0)
            tag = geo.addCircleArc(corner[a], center, corner[b])
        elif curve.smooth:
            inner = [geo.addPoint(x, y, 0.0) for x, y in curve.points[1:-1]]
            tag = geo.addSpline([corner[a], *inner, corner[b]])
        else:
            tag = geo.addLine(corner[a], corner[b])
        tags.append(tag)
        if curve.name:
            groups.setdefault(_word(curve.name), []).append(tag)
    rings = [
        geo.addCurveLoop([-tags[n] if back else tags[n] for n, back in k]) for k in loops.loops
    ]
    surfaces = [geo.addPlaneSurface([rings[k] for k in part]) for part in loops.parts]
    for part, surface in zip(loops.parts, surfaces, strict=True):
        counts = _strip(loops, part, size or _largest(loops), through)
        for (number, _), count in zip(loops.loops[part[0]], counts, strict=False):
            geo.mesh.setTransfiniteCurve(tags[number], count + 1)
        if counts:
            geo.mesh.setTransfiniteSurface(surface)
    geo.synchronize()
    for name, members in groups.items():
        gmsh.model.addPhysicalGroup(1, members, name=name)
    names: dict[str, list[int]] = {}
    for number, (part, surface) in enumerate(zip(loops.parts, surfaces, strict=True), start=1):
        polygon = loops.polygon(part[0])
        inside = [text for text, at in texts if text and contains(polygon, np.array(at))]
        plain = "part" if len(surfaces) == 1 else f"part_{number}"
        name = _word(inside[0]) if inside else plain
        names.setdefault(plain if name in groups else name, []).append(surface)
    for name, members in names.items():
        gmsh.model.addPhysicalGroup(2, members, name=name)


def _largest(loops: Loops) -> float:
    """Largest cell where no size is given [length]."""
    return SIZE * float(np.hypot(*np.ptp(loops.points, axis=0)))


def _strip(loops: Loops, part: list[int], size: float, through: int) -> list[int]:
    """Cells along the four sides of a slender part without holes; empty for other parts."""
    sides = [loops.curves[number] for number, _ in loops.loops[part[0]]]
    if len(part) > 1 or len(sides) != 4:
        return []
    pairs = [0.5 * (sides[k].length + sides[k + 2].length) for k in (0, 1)]
    thin, long = min(pairs), max(pairs)
    if long < SLENDER * thin:
        return []
    across = max(through, math.ceil(thin / size))
    along = math.ceil(long / min(size, ASPECT * thin / across))
    for side in sides:
        if side.center is not None or side.smooth:
            first, last = side.points[1] - side.points[0], side.points[-1] - side.points[-2]
            turn = abs(math.remainder(math.atan2(last[1], last[0]) - math.atan2(first[1], first[0]),
                                      2.0 * math.pi))  # fmt: skip
            along = max(along, math.ceil(AROUND * turn / (2.0 * math.pi)))
    counts = [along, across] if pairs[0] > pairs[1] else [across, along]
    return counts * 2


def _import(gmsh: Any, path: Path, size: float) -> Callable[..., float]:
    """Read faces by Gmsh's geometry kernel; they must lie in a plane z = constant."""
    from corota.io.regular_file import require_regular

    require_regular(path)
    faces = [tag for dim, tag in gmsh.model.occ.importShapes(str(path)) if dim == 2]
    gmsh.model.occ.synchronize()
    faces = faces or [tag for _, tag in gmsh.model.getEntities(2)]
    if not faces:
        raise InputError(f"{path}: there is no face; export a planar face, not a solid or a curve")
    low_x, low_y, low_z, high_x, high_y, high_z = gmsh.model.getBoundingBox(-1, -1)
    diagonal = float(np.hypot(high_x - low_x, high_y - low_y))
    if high_z - low_z > 1e-6 * diagonal:
        raise InputError(f"{path}: the faces do not lie in a plane of constant z")
    for number, face in enumerate(faces, start=1):
        name = "part" if len(faces) == 1 else f"part_{number}"
        gmsh.model.addPhysicalGroup(2, [face], name=name)
    for _, tag in gmsh.model.getBoundary([(2, f) for f in faces], combined=True, oriented=False):
        gmsh.model.addPhysicalGroup(1, [tag], name=f"curve_{tag}")
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", AROUND)
    largest = size or SIZE * diagonal
    return lambda dim, tag, x, y, z, lc: min(lc, largest)


def _sizes(loops: Loops, size: float, through: int) -> Callable[..., float]:
    """Size of the cells at a place, as Gmsh requests it."""
    from scipy.spatial import cKDTree

    largest = size or _largest(loops)
    places, wanted = [], []
    starts, steps = [], []
    for loop in range(len(loops.loops)):
        at = loops.polygon(loop)
        starts.append(at)
        steps.append(np.roll(at, -1, axis=0) - at)
    first, step = np.vstack(starts), np.vstack(steps)
    for number, curve in enumerate(loops.curves):
        at = _spaced(curve.points, largest)
        middle = 0.5 * (at[:-1] + at[1:])
        limit = np.full(len(middle), largest)
        if curve.center is not None:
            radius = float(np.hypot(*(curve.points[0] - curve.center)))
            limit = np.minimum(limit, 2.0 * np.pi * radius / AROUND)
        elif curve.smooth:
            limit = np.minimum(limit, 2.0 * np.pi * _radii(curve.points, middle) / AROUND)
        along = np.diff(at, axis=0)
        normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(*along.T)[:, None]
        if _runs_backwards(loops, number):
            normal = -normal
        thickness = _thickness(middle, normal, first, step)
        places.append(middle)
        wanted.append(np.minimum(limit, thickness / through))
    tree, small = cKDTree(np.vstack(places)), np.concatenate(wanted)

    def at_place(dim: int, tag: int, x: float, y: float, z: float, lc: float) -> float:
        distance, near = tree.query((x, y), k=min(8, len(small)))
        return float(np.minimum(largest, small[near] + GROWTH * distance).min())

    return at_place


def _spaced(points: Floats, size: float) -> Floats:
    """Points of a polygon with others between that are not farther apart than `size`."""
    found = [points[:1]]
    for a, b in pairwise(points):
        count = max(1, int(np.ceil(np.hypot(*(b - a)) / size)))
        found.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
    return np.vstack(found)


def _radii(points: Floats, at: Floats) -> Floats:
    """Radius of curvature of a spline, by the circle through three points, at the nearest ones."""
    if len(points) < 3:
        return np.full(len(at), np.inf)
    before, after = np.diff(points[:-1], axis=0), np.diff(points[1:], axis=0)
    chord = points[2:] - points[:-2]
    turn = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
    product = np.hypot(*before.T) * np.hypot(*after.T) * np.hypot(*chord.T)
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = np.where(turn > 1e-12 * product.max() ** (2 / 3), product / (2.0 * turn), np.inf)
    apart = np.linalg.norm(at[:, None] - points[None, 1:-1], axis=2)
    return np.asarray(radius[apart.argmin(axis=1)])


def _runs_backwards(loops: Loops, number: int) -> bool:
    """Whether the material is to the right of a curve: loops are counter-clockwise, holes too."""
    outer = {part[0] for part in loops.parts}
    for k, loop in enumerate(loops.loops):
        for n, back in loop:
            if n == number:
                return back if k in outer else not back
    return False


def _thickness(at: Floats, normal: Floats, first: Floats, step: Floats) -> Floats:
    """Distance to the opposite side along the inward normal, shape (n,)."""
    found = np.full(len(at), np.inf)
    for k in range(len(at)):
        cross = normal[k, 0] * step[:, 1] - normal[k, 1] * step[:, 0]
        apart = first - at[k]
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = (apart[:, 0] * step[:, 1] - apart[:, 1] * step[:, 0]) / cross
            share = (apart[:, 0] * normal[k, 1] - apart[:, 1] * normal[k, 0]) / cross
        own = 1e-6 * np.hypot(*step.T)
        hit = (share >= -1e-9) & (share <= 1.0 + 1e-9) & (distance > own)
        found[k] = distance[hit].min(initial=np.inf)
    return found


def _mesh(
    gmsh: Any,
    sizes: Callable[..., float],
    triangles: bool,
    quadratic: bool,
    path: str | PathLike[str] | None,
) -> Mesh:
    option = gmsh.option.setNumber
    for name in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints"):
        option(f"Mesh.{name}", 0)
    gmsh.model.mesh.setSizeCallback(sizes)
    if not triangles:
        option("Mesh.Algorithm", ALGORITHM)
        option("Mesh.RecombineAll", 1)
        option("Mesh.RecombinationAlgorithm", RECOMBINATION)
    option("Mesh.SecondOrderIncomplete", 1)
    gmsh.model.mesh.generate(2)
    if quadratic:
        gmsh.model.mesh.setOrder(2)
    with tempfile.TemporaryDirectory() as folder:
        own = Path(folder) / "outline.msh"
        gmsh.write(str(own))
        if path is not None:
            copyfile(own, path)
        return read_gmsh(own)


def _word(name: str) -> str:
    """Name of a set from that of a layer or a text."""
    return re.sub(r"\W+", "_", name.strip()).strip("_") or "part"


__all__ = ["outline"]
