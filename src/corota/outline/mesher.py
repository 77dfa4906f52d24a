"""Meshes of outlines by Gmsh: quadrilaterals, sizes by curvature and by the local thickness."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import tempfile
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from shutil import copyfile
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from corota.errors import FileError, InputError, ResourceError
from corota.io.gmsh.reader import read_gmsh
from corota.mesh.quality import corner_angles
from corota.outline.curves import Curve
from corota.outline.drawing import DRAWINGS, Text, set_name
from corota.outline.four_sided import mesh_four_sided
from corota.outline.loops import Loops, clean, contains
from corota.outline.solids import SOLIDS, read_faces
from corota.outline.strips import AROUND, Faces, Rays, cut, sides_of

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator
    from os import PathLike

    from corota.mesh.data import Mesh

#: Largest cell relative to the diagonal of the outline, where no size is given.
SIZE = 0.03
#: Growth of the cell size with the distance from a place of small cells.
GROWTH = 0.25
#: Numbers of Gmsh: frontal triangles, recombined by blossom. Frontal quadrilaterals leave corners
#: of 176 degrees at rims.
ALGORITHM, RECOMBINATION = 6, 1


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
        A drawing (``.dxf``, ``.svg``), a face (``.step``, ``.iges``, ``.brep``), or curves
        (:mod:`corota.outline.curves`). Closed curves are parts; those within a part are holes.
    size : float
        Largest side of a cell [length]; 3 % of the diagonal by default.
    through : int
        Cells across the local thickness, at least; in rows across slender members.
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
        text that stands in a part. ``notes`` says what was cleaned, the unit, and the corners
        of the cells.

    Raises
    ------
    InputError
        If the outline is open or crosses itself, with the places; ``error.plot(path=...)`` draws
        them.
    FileError
        If the file is not readable.
    ResourceError
        If Gmsh, or ezdxf for a drawing, is not installed. Without Gmsh curves whose parts have four
        sides and no holes are meshed by :func:`corota.mesh.mapped`.
    """
    if size < 0.0 or through < 1:
        raise InputError(f"size must be >= 0 and through >= 1, not {size} and {through}")
    curves, texts, notes = _read(source, layers)
    loops = clean(curves, gap)
    notes = [*loops.report, *notes]
    size = size or SIZE * float(np.hypot(*np.ptp(loops.points, axis=0)))
    faces = cut(loops, size, through)
    names = _part_names(loops, texts)
    if find_spec("gmsh") is None and path is None and not triangles:
        mesh = mesh_four_sided(faces, names, size, quadratic)
    else:
        with _gmsh() as gmsh:
            _build(gmsh, faces, names)
            mesh = _mesh(gmsh, _sizes(loops, size, through), triangles, quadratic, path)
    corners = [corner_angles(c.kind, mesh.points[c.nodes]) for c in mesh.cells]
    least, most = min(c.min() for c in corners), max(c.max() for c in corners)
    counts = ", ".join(f"{len(c):,} {c.kind}" for c in mesh.cells)
    mesh.notes = [
        *notes,
        f"{mesh.n_nodes:,} nodes, {counts}; corners of {least:.0f} to {most:.0f} degrees",
    ]
    return mesh


def _read(
    source: str | PathLike[str] | Iterable[Curve], layers: Collection[str]
) -> tuple[list[Curve], list[Text], list[str]]:
    """Curves, texts and notes of a source."""
    if not isinstance(source, (str, Path)):
        curves = []
        for each in cast("Iterable[Curve | list[Curve]]", source):
            curves += each if isinstance(each, list) else [each]
        return curves, [], []
    path = Path(source)
    kind = path.suffix.lower()
    if kind in SOLIDS:
        with _gmsh() as gmsh:
            return read_faces(gmsh, path), [], []
    if kind not in DRAWINGS:
        raise InputError(
            f"{source}: outlines are read from {', '.join([*DRAWINGS, *SOLIDS])}; a mesh is read "
            "by corota.mesh.read"
        )
    drawing = DRAWINGS[kind](path, layers)
    unit = [f"unit of the drawing: {drawing.unit}"] if drawing.unit else []
    return drawing.curves, drawing.texts, [*drawing.notes, *unit]


@contextmanager
def _gmsh() -> Iterator[Any]:
    try:
        import gmsh
    except (ImportError, OSError) as error:
        raise ResourceError(
            f"outlines are meshed by Gmsh, which is not installed ({error}): "
            "pip install corota[mesh]; without it parts need four sides and no hole"
        ) from None
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.add("outline")
        yield gmsh
    except (InputError, FileError, ResourceError):
        raise
    except Exception as error:
        raise InputError(f"Gmsh could not mesh the outline: {error}") from None
    finally:
        gmsh.finalize()


def _build(gmsh: Any, faces: Faces, names: list[str]) -> None:
    """Give the faces to Gmsh, with a physical group for each name; members are meshed in rows."""
    geo = gmsh.model.geo
    corner = [geo.addPoint(x, y, 0.0) for x, y in faces.points]
    tags: list[int] = []
    groups: dict[str, list[int]] = {}
    for curve, (a, b) in zip(faces.curves, faces.ends.tolist(), strict=True):
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
            groups.setdefault(set_name(curve.name), []).append(tag)
    surfaces = []
    for number, face in enumerate(faces.faces):
        loops = [geo.addCurveLoop([-tags[k] if back else tags[k] for k, back in loop])
                 for loop in face]  # fmt: skip
        surfaces.append(geo.addPlaneSurface(loops))
        if number in faces.rows:
            for (k, _), count in zip(face[0], faces.rows[number], strict=True):
                geo.mesh.setTransfiniteCurve(tags[k], count + 1)
            geo.mesh.setTransfiniteSurface(surfaces[-1])
    geo.synchronize()
    for name, members in groups.items():
        gmsh.model.addPhysicalGroup(1, members, name=name)
    parts: dict[str, list[int]] = {}
    for part, surface in zip(faces.parts, surfaces, strict=True):
        parts.setdefault(names[part], []).append(surface)
    for name, members in parts.items():
        gmsh.model.addPhysicalGroup(2, members, name=name)


def _part_names(loops: Loops, texts: list[Text]) -> list[str]:
    """Name of each part: the text within it, or its number."""
    taken = {set_name(curve.name) for curve in loops.curves if curve.name}
    found = []
    for number, part in enumerate(loops.parts, start=1):
        plain = "part" if len(loops.parts) == 1 else f"part_{number}"
        polygon = loops.polygon(part[0])
        inside = [text for text, at in texts if text and contains(polygon, np.array(at))]
        name = set_name(inside[0]) if inside else plain
        found.append(plain if name in taken else name)
    return found


def _sizes(loops: Loops, largest: float, through: int) -> Callable[..., float]:
    """Size of the cells at a place, as Gmsh requests it: by curvature and local thickness."""
    from scipy.spatial import cKDTree

    sides = sides_of(loops)
    rays = Rays(sides)
    places, wanted = [], []
    for side in sides:
        count = math.ceil(side.length / largest)
        s = np.union1d(side.along, side.length * np.linspace(0.0, 1.0, count + 1))
        s = 0.5 * (s[:-1] + s[1:])
        limit = 2.0 * np.pi * side.radius(s) / AROUND
        thickness = rays.hit(side.chord(s), side.inward(s))[0]
        places.append(side.chord(s))
        wanted.append(np.minimum(limit, thickness / through))
    tree, small = cKDTree(np.vstack(places)), np.concatenate(wanted)

    def at_place(dim: int, tag: int, x: float, y: float, z: float, lc: float) -> float:
        distance, near = tree.query((x, y), k=min(8, len(small)))
        return float(np.minimum(largest, small[near] + GROWTH * distance).min())

    return at_place


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
