"""Curves of an SVG drawing: paths by fontTools, and the simple shapes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from corota.arrays import Floats
from corota.errors import FileError, ResourceError
from corota.io.regular_file import require_regular
from corota.outline.curves import Curve, arc, line, spline
from corota.outline.drawing import Drawing

#: Elements that draw nothing where they stand.
SKIPPED = ("defs", "clipPath", "mask", "marker", "pattern", "symbol", "metadata")
#: Points along a Bezier curve.
POINTS = 17
_LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
_LENGTH = re.compile(r"\s*([-+.\deE]+)\s*([a-z]*)")


def read_svg(path: Path, layers: Collection[str] = ()) -> Drawing:
    """Curves, names of parts and unit of a drawing; y points up.

    Parameters
    ----------
    layers : collection of str
        Layers or names to take; all if empty.

    Returns
    -------
    Drawing
        Curves are named by the label of their layer, or by their stroke where there is none.

    Raises
    ------
    ResourceError
        If fontTools is not installed.
    FileError
        If it is not a drawing.
    """
    try:
        import fontTools.svgLib.path  # noqa: F401
    except ImportError:
        raise ResourceError(
            "paths of drawings need fontTools, which is not installed: pip install corota[mesh]"
        ) from None
    require_regular(path)
    try:
        root = ElementTree.parse(path).getroot()
    except (OSError, ElementTree.ParseError, ValueError) as error:
        raise FileError(f"{path}: not a readable SVG drawing: {error}") from None
    result = Drawing()
    matrix, result.unit = _page(root)
    wanted = {name.lower() for name in layers}
    try:
        for element, at, name in _elements(root, matrix, ""):
            if wanted and name.lower() not in wanted:
                continue
            kind = _kind(element)
            if kind == "text":
                place = at @ [_number(element, "x"), _number(element, "y"), 1.0]
                words = " ".join("".join(element.itertext()).split())
                result.texts.append((words, (float(place[0]), float(place[1]))))
            elif kind in _SHAPES:
                result.curves += _curves(_SHAPES[kind](element), at, name, f"{kind} {_id(element)}")
    except (ValueError, AssertionError, IndexError) as error:
        raise FileError(f"{path}: not a readable SVG drawing: {error}") from None
    return result


def _page(root: ElementTree.Element) -> tuple[Floats, str]:
    """Matrix from user units to those of the page, y up, and the unit."""
    box = [float(v) for v in re.split(r"[\s,]+", root.get("viewBox", "").strip()) if v]
    width = _LENGTH.match(root.get("width", ""))
    scale, unit = 1.0, ""
    if width and width[2] in ("mm", "cm", "in") and len(box) == 4 and box[2] > 0.0:
        scale, unit = float(width[1]) / box[2], width[2]
    return np.array([[scale, 0.0, 0.0], [0.0, -scale, 0.0]]), unit


def _elements(
    parent: ElementTree.Element, matrix: Floats, name: str
) -> Iterator[tuple[ElementTree.Element, Floats, str]]:
    """Elements with their matrix and name, groups resolved."""
    for element in parent:
        kind = _kind(element)
        if kind in SKIPPED or not kind or _style(element, "display") == "none":
            continue
        at = matrix @ np.vstack([_transform(element.get("transform", "")), [0.0, 0.0, 1.0]])
        stroke = _style(element, "stroke")
        label = element.get(_LABEL, "" if kind != "g" else element.get("id", "")) or name
        if kind in ("g", "svg", "a"):
            yield from _elements(element, at, label)
        else:
            plain = (
                ""
                if stroke in ("", "none", "black", "#000", "#000000")
                else f"color_{stroke.lstrip('#')}"
            )
            yield element, at, label or plain


def _kind(element: ElementTree.Element) -> str:
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""


def _id(element: ElementTree.Element) -> str:
    return element.get("id", "")


def _style(element: ElementTree.Element, key: str) -> str:
    """A property of the element: an attribute or a part of its style."""
    style = dict(part.split(":", 1) for part in element.get("style", "").split(";") if ":" in part)
    words = {name.strip(): value.strip() for name, value in style.items()}
    return words.get(key, element.get(key, "")).strip()


def _number(element: ElementTree.Element, key: str) -> float:
    found = _LENGTH.match(element.get(key, "") or "0")
    return float(found[1]) if found else 0.0


def _transform(text: str) -> Floats:
    """Matrix of a transform attribute, shape (2, 3)."""
    whole = np.eye(3)
    for name, inside in re.findall(r"(\w+)\s*\(([^)]*)\)", text):
        v = [float(word) for word in re.split(r"[\s,]+", inside.strip()) if word]
        step = np.eye(3)
        if name == "matrix":
            step[:2] = np.reshape(v, (3, 2)).T
        elif name == "translate":
            step[:2, 2] = [v[0], v[1] if len(v) > 1 else 0.0]
        elif name == "scale":
            step[0, 0], step[1, 1] = v[0], v[-1]
        elif name == "rotate":
            c, s = math.cos(math.radians(v[0])), math.sin(math.radians(v[0]))
            turn = np.array([[c, -s], [s, c]])
            about = np.array(v[1:3]) if len(v) == 3 else np.zeros(2)
            step[:2, :2], step[:2, 2] = turn, about - turn @ about
        elif name in ("skewX", "skewY"):
            step[(0, 1) if name == "skewX" else (1, 0)] = math.tan(math.radians(v[0]))
        else:
            raise ValueError(f"unknown transform {name!r}")
        whole = whole @ step
    return whole[:2]


# -- shapes as the text of a path ----------------------------------------------------------


def _path(element: ElementTree.Element) -> str:
    return element.get("d", "")


def _line(element: ElementTree.Element) -> str:
    x1, y1, x2, y2 = (_number(element, key) for key in ("x1", "y1", "x2", "y2"))
    return f"M {x1!r} {y1!r} L {x2!r} {y2!r}"


def _polyline(element: ElementTree.Element) -> str:
    return f"M {element.get('points', '')}" if element.get("points", "").strip() else ""


def _polygon(element: ElementTree.Element) -> str:
    return f"{_polyline(element)} Z" if _polyline(element) else ""


def _rect(element: ElementTree.Element) -> str:
    x, y, w, h = (_number(element, key) for key in ("x", "y", "width", "height"))
    a, b = _number(element, "rx"), _number(element, "ry")
    a, b = min(a or b, 0.5 * w), min(b or a, 0.5 * h)
    if not a:
        return f"M {x!r} {y!r} H {x + w!r} V {y + h!r} H {x!r} Z"
    turn = f"A {a!r} {b!r} 0 0 1"
    return (
        f"M {x + a!r} {y!r} H {x + w - a!r} {turn} {x + w!r} {y + b!r} V {y + h - b!r} "
        f"{turn} {x + w - a!r} {y + h!r} H {x + a!r} {turn} {x!r} {y + h - b!r} V {y + b!r} "
        f"{turn} {x + a!r} {y!r} Z"
    )


def _ellipse(element: ElementTree.Element) -> str:
    x, y, r = (_number(element, key) for key in ("cx", "cy", "r"))
    a, b = r or _number(element, "rx"), r or _number(element, "ry")
    turn = f"A {a!r} {b!r} 0 0 1"
    return f"M {x - a!r} {y!r} {turn} {x + a!r} {y!r} {turn} {x - a!r} {y!r} Z"


#: The text of a path for each shape.
_SHAPES: dict[str, Callable[[ElementTree.Element], str]] = {
    "path": _path,
    "line": _line,
    "polyline": _polyline,
    "polygon": _polygon,
    "rect": _rect,
    "circle": _ellipse,
    "ellipse": _ellipse,
}


class _Pen:
    """Collects the curves of a path, as fontTools calls it; arcs stay arcs.

    Parameters
    ----------
    matrix : ndarray, shape (2, 3)
    """

    def __init__(self, matrix: Floats, name: str, source: str) -> None:
        self.matrix, self.name, self.source = matrix, name, source
        self.curves: list[Curve] = []
        self.start = self.here = (0.0, 0.0)

    def _at(self, *points: tuple[float, float]) -> Floats:
        return np.asarray(np.array(points) @ self.matrix[:, :2].T + self.matrix[:, 2])

    def moveTo(self, point: tuple[float, float]) -> None:
        self.start = self.here = point

    def lineTo(self, point: tuple[float, float]) -> None:
        if point != self.here:
            first, last = self._at(self.here, point)
            self.curves.append(line(first, last, self.name, self.source))
        self.here = point

    def curveTo(self, *points: tuple[float, float]) -> None:
        control = self._at(self.here, *points)
        self.curves += spline(_bezier(control), self.name, self.source)
        self.here = points[-1]

    qCurveTo = curveTo

    def arcTo(
        self, rx: float, ry: float, rotation: float, large: int, sweep: int,
        point: tuple[float, float],
    ) -> None:  # fmt: skip
        if point == self.here or not (rx and ry):
            self.lineTo(point)
            return
        center, axes, first, turn = _ellipse_arc(
            self.here, point, abs(rx), abs(ry), math.radians(rotation), bool(large), bool(sweep)
        )
        axes = self.matrix[:, :2] @ axes
        lengths = np.hypot(*axes)
        if abs(lengths[0] - lengths[1]) + abs(axes[:, 0] @ axes[:, 1]) / lengths[0] < (
            1e-9 * lengths[0]
        ):
            way = math.copysign(1.0, axes[0, 0] * axes[1, 1] - axes[0, 1] * axes[1, 0])
            start = math.atan2(axes[1, 0], axes[0, 0]) + way * first
            self.curves += arc(self._at(tuple(center))[0], float(lengths[0]), start,
                               start + way * turn, self.name, self.source)  # fmt: skip
        else:
            t = first + turn * np.linspace(0.0, 1.0, 4 * POINTS)
            at = self._at(tuple(center)) + np.column_stack([np.cos(t), np.sin(t)]) @ axes.T
            self.curves += spline(at, self.name, self.source)
        self.here = point

    def closePath(self) -> None:
        self.lineTo(self.start)

    def endPath(self) -> None:
        pass


def _ellipse_arc(
    first: tuple[float, float], last: tuple[float, float], rx: float, ry: float, rotation: float,
    large: bool, sweep: bool,
) -> tuple[Floats, Floats, float, float]:  # fmt: skip
    """Center, axes (columns), first angle and turn of an arc given by its ends.

    Source: Scalable Vector Graphics (SVG) 2, appendix B.2.4.
    """
    c, s = math.cos(rotation), math.sin(rotation)
    turned = np.array([[c, s], [-s, c]])
    half = turned @ (0.5 * (np.array(first) - np.array(last)))
    x, y = half
    grown = math.sqrt((x / rx) ** 2 + (y / ry) ** 2)
    if grown > 1.0:
        rx, ry = rx * grown, ry * grown
    square = (rx * ry) ** 2 / ((rx * y) ** 2 + (ry * x) ** 2) - 1.0
    root = math.sqrt(max(square, 0.0)) * (-1.0 if large == sweep else 1.0)
    middle = root * np.array([rx * y / ry, -ry * x / rx])
    center = turned.T @ middle + 0.5 * (np.array(first) + np.array(last))
    a = math.atan2((y - middle[1]) / ry, (x - middle[0]) / rx)
    b = math.atan2((-y - middle[1]) / ry, (-x - middle[0]) / rx)
    turn = (b - a) % (2.0 * math.pi)
    return center, turned.T @ np.diag([rx, ry]), a, turn if sweep else turn - 2.0 * math.pi


def _curves(text: str, matrix: Floats, name: str, source: str) -> list[Curve]:
    from fontTools.svgLib.path import parse_path

    pen = _Pen(matrix, name, source)
    parse_path(text, pen)
    return pen.curves


def _bezier(control: Floats) -> Floats:
    """Points on the Bezier curve of its control points."""
    t = np.linspace(0.0, 1.0, POINTS)
    n = len(control) - 1
    weights = [math.comb(n, k) * t**k * (1.0 - t) ** (n - k) for k in range(n + 1)]
    return np.asarray(np.column_stack(weights) @ control)
