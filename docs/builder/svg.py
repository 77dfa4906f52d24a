"""Small SVG figures that follow the light or dark colors of the page."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import textwrap
from dataclasses import dataclass, field
from html import escape

#: Colors by role, light and dark.
COLORS = {
    "ink": ("#1f2933", "#e6e9ed"),
    "soft": ("#66727f", "#9aa5b1"),
    "fill": ("#e9f0f6", "#26323e"),
    "node": ("#1f2933", "#e6e9ed"),
    "face": ("#0b6392", "#66bfe8"),
    "load": ("#b23c17", "#ff9d70"),
    "good": ("#1a7441", "#74cc96"),
    "warm": ("#8a5a00", "#e8b954"),
    "plum": ("#7a3b8f", "#cf9be0"),
}
_STROKES = "".join(
    f".fig .{name}{{stroke:var(--{name});fill:none}}.fig .{name}-fill{{fill:var(--{name})}}"
    for name in COLORS
)


def _variables(which: int) -> str:
    return "".join(f"--{name}:{pair[which]};" for name, pair in COLORS.items())


#: An ``img`` follows the colors of the system, a figure inside the page those of the page.
STYLE = (
    f".fig{{{_variables(0)}font-family:system-ui,'Segoe UI',Helvetica,Arial,sans-serif;"
    "font-size:14px;max-width:100%;height:auto}"
    f"@media (prefers-color-scheme:dark){{.fig{{{_variables(1)}}}}}"
    f"html[data-theme=light] .fig{{{_variables(0)}}}html[data-theme=dark] .fig{{{_variables(1)}}}"
    f"{_STROKES}.fig text{{stroke:none;fill:var(--ink)}}"
    + "".join(f".fig text.{name}{{fill:var(--{name})}}" for name in COLORS)
)


def number(value: float) -> str:
    """A coordinate to a tenth of a pixel."""
    text = f"{value:.1f}".removesuffix(".0")
    return "0" if text == "-0" else text


@dataclass
class Svg:
    """A figure under construction; y grows downwards.

    Parameters
    ----------
    width, height : float
        Size of the figure [px].
    title : str
        What a screen reader says.
    """

    width: float
    height: float
    title: str
    parts: list[str] = field(default_factory=list)

    def line(
        self, points: list[tuple[float, float]], kind: str, width: float = 1.5, extra: str = ""
    ) -> None:
        """A line through points."""
        path = "M" + "L".join(f"{number(x)} {number(y)}" for x, y in points)
        self.parts.append(f'<path class="{kind}" d="{path}" stroke-width="{width}"{extra}/>')

    def path(self, text: str, kind: str, width: float = 1.5) -> None:
        """Any path."""
        self.parts.append(f'<path class="{kind}" d="{text}" stroke-width="{width}"/>')

    def polygon(self, points: list[tuple[float, float]], kind: str) -> None:
        """A filled polygon."""
        path = "M" + "L".join(f"{number(x)} {number(y)}" for x, y in points) + "Z"
        self.parts.append(f'<path class="{kind}" d="{path}"/>')

    def circle(self, x: float, y: float, radius: float, kind: str) -> None:
        """A filled circle."""
        self.parts.append(
            f'<circle class="{kind}" cx="{number(x)}" cy="{number(y)}" r="{radius}"/>'
        )

    def box(self, x: float, y: float, width: float, height: float, kind: str) -> None:
        """A rounded box."""
        place = f'x="{number(x)}" y="{number(y)}" width="{number(width)}" height="{number(height)}"'
        self.parts.append(f'<rect class="fill-fill" {place} rx="6"/>')
        self.parts.append(f'<rect class="{kind}" {place} rx="6" stroke-width="1.5"/>')

    def text(
        self,
        x: float,
        y: float,
        words: str,
        kind: str = "ink",
        anchor: str = "middle",
        size: float = 14,
        bold: bool = False,
    ) -> None:
        """One line of text; y is its baseline."""
        more = ' font-weight="600"' if bold else ""
        self.parts.append(
            f'<text class="{kind}" x="{number(x)}" y="{number(y)}" text-anchor="{anchor}" '
            f'font-size="{size}"{more}>{escape(words, quote=False)}</text>'
        )

    def arrow(
        self, x: float, y: float, to_x: float, to_y: float, kind: str, width: float = 1.5
    ) -> None:
        """A line with a head at its end."""
        length = ((to_x - x) ** 2 + (to_y - y) ** 2) ** 0.5
        along = ((to_x - x) / length, (to_y - y) / length)
        foot = (to_x - 8 * along[0], to_y - 8 * along[1])
        across = (-3.5 * along[1], 3.5 * along[0])
        self.line([(x, y), foot], kind, width)
        sides = [(foot[0] + s * across[0], foot[1] + s * across[1]) for s in (1, -1)]
        self.polygon([(to_x, to_y), *sides], f"{kind}-fill")

    def __str__(self) -> str:
        body = "\n".join(self.parts)
        size = f"{number(self.width)} {number(self.height)}"
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" class="fig" viewBox="0 0 {size}" '
            f'width="{number(self.width)}" height="{number(self.height)}" role="img">\n'
            f"<title>{escape(self.title, quote=False)}</title>\n<style>{STYLE}</style>\n"
            f"{body}\n</svg>\n"
        )


def wrapped(words: str, width: float, size: float = 14) -> list[str]:
    """Lines of a text that fit a width; ``|`` begins a new line."""
    fit = int(width / (0.53 * size))
    return [line for part in words.split("|") for line in textwrap.wrap(part, fit)]


def flow(title: str, steps: list[tuple[str, str]], last: str) -> str:
    """A flow chart: questions below each other, what to do at the right of each *yes*.

    Parameters
    ----------
    title : str
    steps : list of (str, str)
        Question, and what to do where the answer is yes.
    last : str
        What to do where all answers are no.
    """
    left, right, gap, row = 280.0, 400.0, 70.0, 19.0
    rows = []
    y = 10.0
    for question, answer in steps:
        lines = wrapped(question, left - 24, 16), wrapped(answer, right - 24)
        height = row * max(len(lines[0]), len(lines[1])) + 20
        rows.append((y, height, *lines))
        y += height + 34
    end = wrapped(last, left + gap + right - 24)
    height = row * len(end) + 20
    svg = Svg(left + gap + right + 20, y + height + 10, title)

    def words(x: float, y: float, tall: float, lines: list[str], bold: bool = False) -> None:
        start = y + tall / 2 - row * len(lines) / 2 + 14
        for i, line in enumerate(lines):
            svg.text(x, start + row * i, line, anchor="start", bold=bold)

    middle = 10 + left / 2
    for place, tall, question, answer in rows:
        svg.box(10, place, left, tall, "face")
        words(22, place, tall, question, bold=True)
        svg.arrow(10 + left, place + tall / 2, 10 + left + gap, place + tall / 2, "good")
        svg.text(10 + left + gap / 2 - 4, place + tall / 2 - 7, "yes", "good")
        svg.box(10 + left + gap, place, right, tall, "good")
        words(22 + left + gap, place, tall, answer)
        svg.arrow(middle, place + tall, middle, place + tall + 34, "soft")
        svg.text(middle + 8, place + tall + 21, "no", "soft", "start")
    svg.box(10, y, left + gap + right, height, "warm")
    words(22, y, height, end)
    return str(svg)


@dataclass(frozen=True)
class Curve:
    """A curve of a chart."""

    name: str
    x: list[float]
    y: list[float]
    kind: str


def chart(
    title: str,
    curves: list[Curve],
    *,
    x: tuple[str, list[float]],
    y: tuple[str, list[float]],
    levels: tuple[float, ...] = (),
) -> str:
    """Curves over two linear axes; their names stand at their ends.

    Parameters
    ----------
    title : str
    curves : list of Curve
    x, y : (str, list of float)
        Name and ticks of each axis; the ticks span it.
    levels : tuple of float
        Values of y that get a dashed line.
    """
    svg = Svg(660, 380, title)
    frame = (70.0, 30.0, 410.0, 290.0)

    def place(a: float, b: float) -> tuple[float, float]:
        u = (a - x[1][0]) / (x[1][-1] - x[1][0])
        v = (b - y[1][0]) / (y[1][-1] - y[1][0])
        return frame[0] + u * frame[2], frame[1] + (1 - v) * frame[3]

    for tick in x[1]:
        at = place(tick, y[1][0])
        svg.line([at, (at[0], frame[1])], "soft", 0.4)
        svg.text(at[0], at[1] + 20, f"{tick:g}", "soft", size=13)
    for tick in y[1]:
        at = place(x[1][0], tick)
        svg.line([at, (frame[0] + frame[2], at[1])], "soft", 0.4)
        svg.text(at[0] - 8, at[1] + 5, f"{tick:g}", "soft", "end", size=13)
    for level in levels:
        ends = [place(x[1][0], level), place(x[1][-1], level)]
        svg.line(ends, "ink", 1, ' stroke-dasharray="5 4"')
    svg.text(frame[0] + frame[2] / 2, frame[1] + frame[3] + 46, x[0])
    svg.text(10, 18, y[0], anchor="start")
    labels = sorted(curves, key=lambda c: -c.y[-1])
    heights: list[float] = []
    for curve in labels:
        svg.line([place(a, b) for a, b in zip(curve.x, curve.y, strict=True)], curve.kind, 2.2)
        height = place(curve.x[-1], curve.y[-1])[1] + 5
        heights.append(max(height, heights[-1] + 18) if heights else height)
        svg.text(frame[0] + frame[2] + 8, heights[-1], curve.name, curve.kind, "start")
    return str(svg)


__all__ = ["Curve", "Svg", "chart", "flow", "wrapped"]
