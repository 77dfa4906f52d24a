"""Curves of a DXF drawing by ezdxf: lines, arcs, circles, polylines, splines, ellipses, blocks."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from corota.errors import FileError, ResourceError
from corota.io.regular_file import require_regular
from corota.outline.curves import Curve, arc, bulge, circle, line, spline
from corota.outline.drawing import Drawing, Text

#: Unit of each number of ``$INSUNITS`` that has a name here.
UNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m", 13: "um"}
#: Distance of a spline or an ellipse from the points it is replaced by, relative to its size.
FLATTEN = 1e-5
#: Blocks within blocks.
MOST_DEPTH = 16
#: Layers of dimensions and hidden lines, which are no outline.
IGNORED = ("defpoints",)


def read_dxf(path: Path, layers: Collection[str] = ()) -> Drawing:
    """Curves, names of parts and unit of a drawing.

    Parameters
    ----------
    layers : collection of str
        Layers to take; all but ``Defpoints`` if empty.

    Returns
    -------
    Drawing
        Curves are named by their layer, or by their color where the layer is ``0``. Texts, and
        hatches by their layer, name the part around them.

    Raises
    ------
    ResourceError
        If ezdxf is not installed.
    FileError
        If it is not a drawing.
    """
    try:
        import ezdxf
    except ImportError:
        raise ResourceError(
            "drawings need ezdxf, which is not installed: pip install corota[mesh]"
        ) from None
    require_regular(path)
    try:
        drawing = ezdxf.readfile(path)
    except (OSError, ezdxf.DXFError, UnicodeDecodeError, ValueError) as error:
        raise FileError(f"{path}: not a readable DXF drawing: {error}") from None
    wanted = {name.lower() for name in layers}
    result = Drawing(unit=UNITS.get(int(drawing.header.get("$INSUNITS", 0)), ""))
    hatches: list[Text] = []
    left: dict[str, int] = {}
    unseen: dict[str, int] = {}
    hidden = {each.dxf.name.lower() for each in drawing.layers if each.is_off() or each.is_frozen()}
    for entity, layer in _entities(drawing.modelspace(), "", 0):
        if (wanted and layer.lower() not in wanted) or layer.lower() in IGNORED:
            continue
        if layer.lower() in hidden and not wanted:
            unseen[layer] = unseen.get(layer, 0) + 1
            continue
        kind = entity.dxftype()
        if kind in ("TEXT", "MTEXT"):
            text = entity.plain_text() if kind == "MTEXT" else entity.dxf.text
            at = entity.dxf.insert
            result.texts.append((str(text).strip(), (float(at.x), float(at.y))))
            continue
        if kind == "HATCH" and layer != "0":
            hatches += [(layer, at) for at in _within(entity)]
            continue
        source = f"{kind} #{entity.dxf.handle}" + (f" on layer {layer}" if layer != "0" else "")
        found = _curves_of(entity, kind, _name(entity, layer), source)
        if found is None:
            left[kind] = left.get(kind, 0) + 1
        else:
            result.curves += found
    result.texts += hatches  # a text comes first
    result.notes = [
        f"{count} entities {kind} are no outline" for kind, count in sorted(left.items())
    ] + [f"{count} entities on the hidden layer {name!r}" for name, count in unseen.items()]
    return result


def _entities(space: Any, around: str, depth: int) -> Iterator[tuple[Any, str]]:
    """Entities with their layer, blocks resolved: what is on layer 0 there takes that `around`."""
    for entity in space:
        layer = str(entity.dxf.layer)
        if layer == "0" and around:
            layer = around
        if entity.dxftype() == "INSERT" and depth < MOST_DEPTH:
            yield from _entities(entity.virtual_entities(), layer, depth + 1)
        else:
            yield entity, layer


def _name(entity: Any, layer: str) -> str:
    color = int(entity.dxf.get("color", 256))
    if layer != "0":
        return layer
    return "" if color in (0, 7, 256) else f"color_{color}"


def _curves_of(entity: Any, kind: str, name: str, source: str) -> list[Curve] | None:
    data = entity.dxf
    # Coordinates of the object: in a plane that is seen from below x runs the other way.
    way = -1.0 if data.hasattr("extrusion") and data.extrusion.z < 0.0 else 1.0
    if kind == "LINE":
        return [line(_xy(data.start), _xy(data.end), name, source)]
    if kind in ("CIRCLE", "ARC"):
        center = (way * float(data.center[0]), float(data.center[1]))
        if kind == "CIRCLE":
            return circle(center, float(data.radius), name, source)
        start, end = (math.radians(float(a)) for a in (data.start_angle, data.end_angle))
        if way < 0.0:
            start, end = math.pi - end, math.pi - start
        turn = (end - start) % (2.0 * math.pi)
        return arc(center, float(data.radius), start, start + turn, name, source)
    if kind == "LWPOLYLINE":
        points = [
            (way * float(x), float(y), way * float(b)) for x, y, b in entity.get_points("xyb")
        ]
        return _bulged(points, bool(entity.closed), name, source)
    if kind == "POLYLINE" and entity.is_2d_polyline:
        at = [(v.dxf.location, float(v.dxf.get("bulge", 0.0))) for v in entity.vertices]
        points = [(way * float(p.x), float(p.y), way * bend) for p, bend in at]
        return _bulged(points, bool(entity.is_closed), name, source)
    if kind == "POLYLINE" and entity.is_3d_polyline:
        flat = [(float(v.dxf.location.x), float(v.dxf.location.y), 0.0) for v in entity.vertices]
        return _bulged(flat, bool(entity.is_closed), name, source)
    if kind in ("SPLINE", "ELLIPSE"):
        from ezdxf import path as paths

        # Points of the entity itself: its path has cubic curves in place of arcs, off by 2.7e-4.
        near = _tolerance(paths.make_path(entity))
        return spline([_xy(p) for p in entity.flattening(near)], name, source)
    return None


def _within(hatch: Any) -> list[tuple[float, float]]:
    """A point within each hatched area: the middle of a chord through it."""
    from ezdxf import path as paths

    found = []
    for boundary in paths.from_hatch(hatch):
        at = np.array([_xy(p) for p in boundary.flattening(_tolerance(boundary))])
        x, y = at.T
        level = float(np.sort(np.unique(y))[:2].mean())
        nx, ny = np.roll(x, -1), np.roll(y, -1)
        spans = (y > level) != (ny > level)
        crossings = np.sort((x + (level - y) / np.where(spans, ny - y, 1.0) * (nx - x))[spans])
        if len(crossings) > 1:
            found.append((float(crossings[:2].mean()), level))
    return found


def _bulged(
    points: list[tuple[float, float, float]], closed: bool, name: str, source: str
) -> list[Curve]:
    after = points[1:] + points[:1] if closed else points[1:]
    found: list[Curve] = []
    for (x, y, b), (nx, ny, _) in zip(points, after, strict=False):
        if (x, y) != (nx, ny):
            found += bulge((x, y), (nx, ny), b, name, source)
    return found


def _tolerance(path: Any) -> float:
    box = np.array([[p.x, p.y] for p in path.control_vertices()])
    return max(FLATTEN * float(np.ptp(box, axis=0).max()), 1e-12)


def _xy(point: Any) -> tuple[float, float]:
    return float(point[0]), float(point[1])
