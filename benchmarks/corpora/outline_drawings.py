"""Outlines as CAD programs write them, dirt included; each with its exact area and lengths."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

#: ("line", first, last) or ("arc", center, radius, first angle, last angle), and its layer.
Piece = tuple[tuple[Any, ...], str]


@dataclass
class Shape:
    """Closed loops of pieces; the first loop is the outer one of each part.

    Parameters
    ----------
    loops : list of list of Piece
    parts : int
    """

    loops: list[list[Piece]]
    parts: int = 1
    area: float = field(init=False)
    lengths: dict[str, float] = field(init=False)

    def __post_init__(self) -> None:
        sizes = [abs(sum(_green(piece) for piece, _ in loop)) for loop in self.loops]
        self.area = sum(sizes[: self.parts]) - sum(sizes[self.parts :])
        self.lengths = {}
        for loop in self.loops:
            for piece, layer in loop:
                self.lengths[layer] = self.lengths.get(layer, 0.0) + _length(piece)


def _green(piece: tuple[Any, ...]) -> float:
    if piece[0] == "line":
        (x, y), (u, v) = piece[1:]
        return 0.5 * (x * v - u * y)
    _, (cx, cy), r, a, b = piece
    sweep = r * r * (b - a)
    return 0.5 * (sweep + r * (cx * (math.sin(b) - math.sin(a)) - cy * (math.cos(b) - math.cos(a))))


def _length(piece: tuple[Any, ...]) -> float:
    if piece[0] == "line":
        return math.dist(*piece[1:])
    return abs(piece[2] * (piece[4] - piece[3]))


def ends(piece: tuple[Any, ...]) -> tuple[tuple[float, float], tuple[float, float]]:
    """First and last point of a piece."""
    if piece[0] == "line":
        return piece[1], piece[2]
    _, (cx, cy), r, a, b = piece
    return (
        (cx + r * math.cos(a), cy + r * math.sin(a)),
        (cx + r * math.cos(b), cy + r * math.sin(b)),
    )


# -- shapes ------------------------------------------------------------------------------


def polygon(points: list[tuple[float, float]], layer: str = "body", **other: str) -> list[Piece]:
    """Straight sides; `other`: layers of some sides, ``s0`` is the first."""
    last = [*points[1:], points[0]]
    return [
        (("line", a, b), other.get(f"s{k}", layer))
        for k, (a, b) in enumerate(zip(points, last, strict=True))
    ]


def circle(x: float, y: float, r: float, layer: str = "hole") -> list[Piece]:
    half = [("arc", (x, y), r, 0.0, math.pi), ("arc", (x, y), r, math.pi, 2.0 * math.pi)]
    return [(piece, layer) for piece in half]


def rounded(w: float, h: float, r: float, x: float = 0.0, y: float = 0.0, layer: str = "body"):
    """A rectangle with round corners."""
    quarter = 0.5 * math.pi
    at = [(x + w - r, y + r), (x + w - r, y + h - r), (x + r, y + h - r), (x + r, y + r)]
    loop: list[Piece] = []
    for k, center in enumerate(at):
        arc = ("arc", center, r, (k - 1) * quarter, k * quarter)
        if loop and math.dist(ends(loop[-1][0])[1], ends(arc)[0]) > 1e-9:
            loop.append((("line", ends(loop[-1][0])[1], ends(arc)[0]), layer))
        loop.append((arc, layer))
    last, first = ends(loop[-1][0])[1], ends(loop[0][0])[0]
    if math.dist(last, first) > 1e-9:
        loop.append((("line", last, first), layer))
    return loop


def notch(length: float = 40.0, height: float = 12.0, r: float = 5.0) -> list[Piece]:
    """A strip with two round notches."""
    m = 0.5 * length
    return [
        (("line", (0.0, 0.0), (m - r, 0.0)), "body"),
        (("arc", (m, 0.0), r, math.pi, 0.0), "notch"),
        (("line", (m + r, 0.0), (length, 0.0)), "body"),
        (("line", (length, 0.0), (length, height)), "load"),
        (("line", (length, height), (m + r, height)), "body"),
        (("arc", (m, height), r, 0.0, -math.pi), "notch"),
        (("line", (m - r, height), (0.0, height)), "body"),
        (("line", (0.0, height), (0.0, 0.0)), "clamp"),
    ]


def _hooks() -> list[Piece]:
    """A bent leaf of two straight legs and half a ring, 1 thick."""
    half = math.pi
    return [
        (("line", (0.0, 0.0), (30.0, 0.0)), "outer"),
        (("arc", (30.0, 6.0), 6.0, -0.5 * half, 0.5 * half), "outer"),
        (("line", (30.0, 12.0), (0.0, 12.0)), "outer"),
        (("line", (0.0, 12.0), (0.0, 11.0)), "load"),
        (("line", (0.0, 11.0), (30.0, 11.0)), "inner"),
        (("arc", (30.0, 6.0), 5.0, 0.5 * half, -0.5 * half), "inner"),
        (("line", (30.0, 1.0), (0.0, 1.0)), "inner"),
        (("line", (0.0, 1.0), (0.0, 0.0)), "clamp"),
    ]


SHAPES: dict[str, Shape] = {
    "leaf": Shape([polygon([(0, 0), (60, 0), (60, 0.8), (0, 0.8)], s3="clamp", s1="load")]),
    "bracket": Shape([polygon([(0, 0), (30, 0), (30, 3), (3, 3), (3, 20), (0, 20)], s5="clamp")]),
    "plate": Shape([rounded(50, 30, 6), circle(15, 15, 5), circle(35, 15, 5, "bore")]),
    "slot": Shape([polygon([(0, 0), (40, 0), (40, 16), (0, 16)]),
                   rounded(20, 6, 3, 10, 5, "slot")]),
    "washer": Shape([circle(3, -2, 12, "rim"), circle(3, -2, 7)]),
    "notch": Shape([notch()]),
    "parallelogram": Shape([polygon([(0, 0), (44, 0), (44, 50), (0, 50)], s0="clamp"),
                            polygon([(1, 5), (43, 5), (43, 45), (1, 45)], "window")]),
    "folded": Shape([polygon([(0, 0), (2, 0), (2, 38), (10, 38), (10, 0), (12, 0), (12, 38),
                              (20, 38), (20, 0), (22, 0), (22, 40), (0, 40)], s0="clamp")]),
    "v-beam": Shape([polygon([(0, 0), (50, 3), (100, 0), (100, 2), (50, 5), (0, 2)],
                             s5="clamp", s2="clamp")]),
    "hub": Shape([circle(0, 0, 20, "rim"), *[circle(12 * math.cos(a), 12 * math.sin(a), 3)
                                           for a in (0.0, 2.1, 4.2)]]),
    "tongs": Shape([polygon([(0, 0), (60, 4), (60, 8), (5, 6), (5, 14), (60, 12), (60, 16),
                             (0, 20)], s7="clamp")]),
    "stage": Shape([polygon([(0, 0), (60, 0), (60, 46), (0, 46)], s0="clamp", s2="load"),
                    rounded(58, 36, 1.5, 1, 5, "window")]),
    "hooks": Shape([_hooks()]),
    "two": Shape([polygon([(0, 0), (20, 0), (20, 8), (0, 8)]),
                  polygon([(30, 0), (50, 0), (40, 12)]), circle(40, 4, 2)], parts=2),
}  # fmt: skip

# -- dialects ----------------------------------------------------------------------------


def _new(version: str, unit: int = 4) -> Any:
    import ezdxf

    drawing = ezdxf.new(version)
    drawing.header["$INSUNITS"] = unit
    return drawing


def _draw_arc(space: Any, piece: tuple[Any, ...], layer: str) -> None:
    _, center, r, a, b = piece
    low, high = sorted((math.degrees(a), math.degrees(b)))
    space.add_arc(center, r, low, high, dxfattribs={"layer": layer})


def exploded(shape: Shape, path: Path, rng: Any, version: str = "R2000") -> None:
    """Single lines and arcs in any order and direction, as exploded drawings have them."""
    drawing = _new(version)
    pieces = [p for loop in shape.loops for p in loop]
    for k in rng.permutation(len(pieces)):
        piece, layer = pieces[k]
        if piece[0] == "arc":
            _draw_arc(drawing.modelspace(), piece, layer)
        else:
            a, b = piece[1:] if rng.random() < 0.5 else (piece[2], piece[1])
            drawing.modelspace().add_line(a, b, dxfattribs={"layer": layer})
    drawing.saveas(path)


def release_12(shape: Shape, path: Path, rng: Any) -> None:
    """The same in release 12, without units."""
    exploded(shape, path, rng, "R12")


def _polylines(shape: Shape, add: Callable[..., Any]) -> None:
    """Runs of one layer as polylines with bulges."""
    for loop in shape.loops:
        runs: list[list[Piece]] = []
        for piece in loop:
            if runs and runs[-1][-1][1] == piece[1]:
                runs[-1].append(piece)
            else:
                runs.append([piece])
        for run in runs:
            points = []
            for piece, _ in run:
                turn = piece[4] - piece[3] if piece[0] == "arc" else 0.0
                points.append((*ends(piece)[0], math.tan(0.25 * turn)))
            closed = math.dist(ends(run[-1][0])[1], ends(run[0][0])[0]) < 1e-9
            if not closed:
                points.append((*ends(run[-1][0])[1], 0.0))
            add(points, closed, run[0][1])


def polylines(shape: Shape, path: Path, rng: Any) -> None:
    """Light polylines with bulges."""
    drawing = _new("R2010")

    def add(points: Any, closed: bool, layer: str) -> None:
        drawing.modelspace().add_lwpolyline(
            points, format="xyb", close=closed, dxfattribs={"layer": layer}
        )

    _polylines(shape, add)
    drawing.saveas(path)


def old_polylines(shape: Shape, path: Path, rng: Any) -> None:
    """Heavy polylines of release 12."""
    drawing = _new("R12")

    def add(points: Any, closed: bool, layer: str) -> None:
        drawing.modelspace().add_polyline2d(
            points, format="xyb", close=closed, dxfattribs={"layer": layer}
        )

    _polylines(shape, add)
    drawing.saveas(path)


def mirrored(shape: Shape, path: Path, rng: Any) -> None:
    """Polylines seen from below: extrusion along -z, x changes its sign."""
    drawing = _new("R2000")

    def add(points: Any, closed: bool, layer: str) -> None:
        flipped = [(-x, y, -b) for x, y, b in points]
        drawing.modelspace().add_lwpolyline(
            flipped, format="xyb", close=closed,
            dxfattribs={"layer": layer, "extrusion": (0, 0, -1)},
        )  # fmt: skip

    _polylines(shape, add)
    drawing.saveas(path)


def splines(shape: Shape, path: Path, rng: Any) -> None:
    """Arcs as splines, as drawing programs for artists export them."""
    drawing = _new("R2010")
    for loop in shape.loops:
        for piece, layer in loop:
            if piece[0] == "line":
                drawing.modelspace().add_line(*piece[1:], dxfattribs={"layer": layer})
                continue
            _, (cx, cy), r, a, b = piece
            t = np.linspace(a, b, 25)
            at = np.column_stack([cx + r * np.cos(t), cy + r * np.sin(t)])
            at[0], at[-1] = ends(piece)
            drawing.modelspace().add_spline([(*p, 0.0) for p in at], dxfattribs={"layer": layer})
    drawing.saveas(path)


def block(shape: Shape, path: Path, rng: Any) -> None:
    """Within a block that is mirrored, turned, scaled and moved; in inches."""
    drawing = _new("R2010", unit=1)
    part = drawing.blocks.new("PART")
    for loop in shape.loops:
        for piece, layer in loop:
            if piece[0] == "arc":
                _draw_arc(part, piece, layer)
            else:
                part.add_line(*piece[1:], dxfattribs={"layer": layer})
    drawing.modelspace().add_blockref(
        "PART", (7.0, -3.0), dxfattribs={"xscale": -1.0, "rotation": 30.0}
    )
    drawing.saveas(path)


def dirty(shape: Shape, path: Path, rng: Any) -> None:
    """Ends that miss each other, doubles, points, dimensions, hatches, hidden lines."""
    drawing = _new("R2010")
    space = drawing.modelspace()
    every = np.array([ends(p)[0] for loop in shape.loops for p, _ in loop])
    slack = 2e-6 * float(np.hypot(*np.ptp(every, axis=0)))
    pieces = [p for loop in shape.loops for p in loop]
    for piece, layer in [*pieces, *pieces[:3]]:
        if piece[0] == "arc":
            _draw_arc(space, piece, layer)
        else:
            a, b = (np.array(p) + rng.uniform(-slack, slack, 2) for p in piece[1:])
            space.add_line(tuple(a), tuple(b), dxfattribs={"layer": layer})
    first = tuple(every[0])
    space.add_line(first, first, dxfattribs={"layer": "body"})
    space.add_point((1.0, 1.0))
    space.add_line((-9.0, -9.0), (99.0, 55.0), dxfattribs={"layer": "Defpoints"})
    hatch = space.add_hatch(color=2)
    hatch.paths.add_polyline_path([(0, 0), (1, 0), (1, 1)], is_closed=True)
    space.add_linear_dim(base=(0, -5), p1=(0, 0), p2=(30, 0)).render()
    drawing.saveas(path)


def sketch(shape: Shape, path: Path, rng: Any) -> None:
    """Entities alone, without header and tables: three-dimensional polylines and arcs, CRLF."""
    rows: list[tuple[int, Any]] = [(0, "SECTION"), (2, "ENTITIES")]
    for loop in shape.loops:
        for piece, layer in loop:
            if piece[0] == "arc":
                _, (x, y), r, a, b = piece
                low, high = sorted((math.degrees(a), math.degrees(b)))
                rows += [(0, "ARC"), (8, layer), (10, x), (20, y), (30, 0.0), (40, r)]
                rows += [(50, low % 360.0), (51, high % 360.0)]
                continue
            rows += [(0, "POLYLINE"), (8, layer), (66, 1), (10, 0.0), (20, 0.0), (30, 0.0), (70, 8)]
            for x, y in piece[1:]:
                rows += [(0, "VERTEX"), (8, layer), (10, x), (20, y), (30, 0.0), (70, 32)]
            rows += [(0, "SEQEND"), (8, layer)]
    rows += [(0, "ENDSEC"), (0, "EOF")]
    text = "".join(
        f"{code:>3}\r\n{value if not isinstance(value, float) else f'{value:.12E}'}\r\n"
        for code, value in rows
    )
    path.write_bytes(text.encode())


def vector(shape: Shape, path: Path, rng: Any) -> None:
    """An SVG page of a drawing program: layers as groups, moved, y down, in millimeters."""
    groups: dict[str, list[str]] = {}
    for loop in shape.loops:
        for piece, layer in loop:
            (x, y), (u, v) = ends(piece)
            if piece[0] == "line":
                words = f"m {x!r},{y!r} {u - x!r},{v - y!r}"
            else:
                _, _, r, a, b = piece
                large, sweep = int(abs(b - a) > math.pi + 1e-9), int(b > a)
                words = f"M {x!r} {y!r} A {r!r} {r!r} 0 {large} {sweep} {u!r} {v!r}"
            groups.setdefault(layer, []).append(f'<path style="fill:none" d="{words}"/>')
    moved = 'transform="translate(3,-2)"'
    inner = "".join(
        f'<g id="layer{k}" inkscape:label="{layer}" {moved}>{"".join(paths)}</g>'
        for k, (layer, paths) in enumerate(groups.items())
    )
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="200mm" '
        'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" viewBox="0 0 200 200">'
        f"<defs><path d='M 0 0 L 1 1'/></defs>{inner}</svg>"
    )


def solid(shape: Shape, path: Path, rng: Any) -> None:
    """A STEP file with a planar face for each part; it has no layers."""
    import gmsh

    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        occ = gmsh.model.occ
        wires = []
        for loop in shape.loops:
            corners = [occ.addPoint(*ends(piece)[0], 0.0) for piece, _ in loop]
            tags = []
            for k, (piece, _) in enumerate(loop):
                a, b = corners[k], corners[(k + 1) % len(loop)]
                if piece[0] == "line":
                    tags.append(occ.addLine(a, b))
                    continue
                _, (x, y), r, first, last = piece
                middle = 0.5 * (first + last)
                at = occ.addPoint(x + r * math.cos(middle), y + r * math.sin(middle), 0.0)
                tags.append(occ.addCircleArc(a, at, b, center=False))
            wires.append(occ.addCurveLoop(tags))
        for k in range(shape.parts):
            holes = wires[shape.parts :] if k == shape.parts - 1 else []
            occ.addPlaneSurface([wires[k], *holes])
        occ.synchronize()
        gmsh.write(str(path))
    finally:
        gmsh.finalize()


DIALECTS: dict[str, Callable[[Shape, Path, Any], None]] = {
    f.__name__: f
    for f in (
        exploded,
        release_12,
        polylines,
        old_polylines,
        mirrored,
        splines,
        block,
        dirty,
        sketch,
        vector,
        solid,
    )
}
#: Ending of the files of dialects that are no DXF.
ENDINGS = {"vector": ".svg", "solid": ".step"}
#: Outlines of the corpus: each shape in five of the dialects.
CORPUS = [
    (name, dialect)
    for k, name in enumerate(SHAPES)
    for dialect in [list(DIALECTS)[(5 * k + j) % len(DIALECTS)] for j in range(5)]
]

# -- drawings that are refused -----------------------------------------------------------


def _lines(path: Path, *segments: tuple[Any, Any]) -> None:
    drawing = _new("R2000")
    for a, b in segments:
        drawing.modelspace().add_line(a, b)
    drawing.saveas(path)


BOX = [((0, 0), (4, 0)), ((4, 0), (4, 3)), ((4, 3), (0, 3)), ((0, 3), (0, 0))]
#: Drawing and a part of its message.
REFUSED: dict[str, tuple[Callable[[Path], None], str]] = {
    "open": (lambda p: _lines(p, *BOX[:3]), r"open at \(0, [03]\), \(0, [03]\)"),
    "gap": (lambda p: _lines(p, *BOX[:3], ((0, 3), (0, 0.01))), r"nearest ends are 0\.01 apart"),
    "crossing": (lambda p: _lines(p, ((0, 0), (4, 3)), ((4, 3), (4, 0)), ((4, 0), (0, 3)),
                                  ((0, 3), (0, 0))), r"cross at \(2, 1\.5\)"),
    "bridge": (lambda p: _lines(p, *BOX, ((0, 0), (4, 3))), "three or more curves meet"),
    "stray": (lambda p: _lines(p, *BOX, ((1, 1), (2, 2))), "open at"),
    "empty": (lambda p: _lines(p), "no curves"),
    "point": (lambda p: _lines(p, ((0, 0), (0, 0))), "longer than the gap|no curves"),
}  # fmt: skip


__all__ = ["CORPUS", "DIALECTS", "ENDINGS", "REFUSED", "SHAPES", "Shape", "ends"]
