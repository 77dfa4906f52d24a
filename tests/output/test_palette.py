"""Colors are legible on their ground and stay apart for color-blind readers, by computation."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import itertools
import re

import numpy as np
import pytest
from numpy.typing import NDArray

from corota.plots import palette
from corota.report.page import asset, script

Floats = NDArray[np.float64]
#: Linear RGB as seen without one kind of cones (Machado, Oliveira and Fernandes, 2009, severity 1).
SIGHTS: dict[str, Floats] = {
    "all cones": np.eye(3),
    "no red": np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
    "no green": np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ]
    ),
    "no blue": np.array(
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ]
    ),
}
#: sRGB to XYZ over the white point D65 (IEC 61966-2-1).
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = XYZ.sum(axis=1)
#: Contrast of text and of graphics (WCAG 2.1, 1.4.3 and 1.4.11).
TEXT, GRAPHICS = 4.5, 3.0
#: Distances in CIELAB: 2.3 is just noticeable (Mahy and others, 1994).
NOTICEABLE, APART = 2.3, 12.0


def linear(color: str) -> Floats:
    """Linear RGB of ``#rrggbb``."""
    value = np.array([int(color[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def lab(color: str, sight: Floats) -> Floats:
    """CIELAB of a color as seen."""
    ratio = XYZ @ np.clip(sight @ linear(color), 0.0, 1.0) / WHITE
    f = np.where(ratio > 216 / 24389, np.cbrt(ratio), (24389 / 27 * ratio + 16.0) / 116.0)
    return np.array([116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])])


def contrast(one: str, other: str) -> float:
    """Ratio of luminances, as WCAG defines it."""
    low, high = sorted(float(XYZ[1] @ linear(c)) for c in (one, other))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("sight", SIGHTS)
@pytest.mark.parametrize("lines", [palette.LINES, palette.DARK_LINES], ids=["light", "dark"])
def test_lines_stay_apart(lines: tuple[str, ...], sight: str) -> None:
    seen = [lab(color, SIGHTS[sight]) for color in lines]
    assert min(np.linalg.norm(a - b) for a, b in itertools.combinations(seen, 2)) > APART


@pytest.mark.parametrize(
    ("lines", "ground"),
    [(palette.LINES, palette.GROUND), (palette.DARK_LINES, palette.DARK_GROUND)],
    ids=["light", "dark"],
)
def test_lines_are_clear_on_their_ground(lines: tuple[str, ...], ground: str) -> None:
    assert min(contrast(color, ground) for color in lines) > GRAPHICS


@pytest.mark.parametrize("sight", SIGHTS)
@pytest.mark.parametrize("name", palette.MAPS)
def test_neighboring_bands_of_a_map_differ(name: str, sight: str) -> None:
    seen = [lab(color, SIGHTS[sight]) for color in palette.stops(name)[::2]]
    assert min(np.linalg.norm(a - b) for a, b in itertools.pairwise(seen)) > NOTICEABLE


@pytest.mark.parametrize("sight", SIGHTS)
def test_sequential_map_darkens_steadily(sight: str) -> None:
    lightness = [lab(color, SIGHTS[sight])[0] for color in palette.stops(palette.SEQUENTIAL)]
    assert (np.diff(lightness) < 0.0).all()


@pytest.mark.parametrize("sight", SIGHTS)
def test_diverging_map_is_white_at_zero_and_its_sides_differ(sight: str) -> None:
    stops = palette.stops(palette.DIVERGING)
    lightness = np.array([lab(color, SIGHTS[sight])[0] for color in stops])
    middle = len(stops) // 2
    assert lightness.argmax() == middle
    assert lab(stops[middle], SIGHTS[sight])[0] > 95.0
    assert (np.diff(lightness[: middle + 1]) > 0.0).all()
    assert (np.diff(lightness[middle:]) < 0.0).all()
    for one, other in zip(stops[: middle - 3], reversed(stops), strict=False):
        assert np.linalg.norm(lab(one, SIGHTS[sight]) - lab(other, SIGHTS[sight])) > APART


def test_map_follows_the_signs() -> None:
    assert palette.map_of(0.0, 5.0, signed=False) == palette.SEQUENTIAL
    assert palette.map_of(-0.05, 5.0, signed=True) == palette.POSITIVE
    assert palette.map_of(-1.0, 5.0, signed=True) == palette.DIVERGING
    assert palette.map_of(-5.0, -1.0, signed=True) == palette.NEGATIVE


@pytest.mark.parametrize("shade", ["light", "dark"])
def test_texts_of_the_report_are_legible(shade: str) -> None:
    blocks = re.findall(r":root[^{]*\{(.*?)\}", asset("style.css"), re.DOTALL)
    text = blocks[shade == "dark"]
    color = dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})", text))
    for name in ("ink", "soft", "accent", "danger", "good"):
        for ground in ("ground", "panel"):
            assert contrast(color[name], color[ground]) > TEXT, (name, ground)
    for name in (
        "outline",
        "ghost",
        "rigid",
        "beam",
        "link",
        "support",
        "load",
        "travel",
        "contact",
    ):
        assert contrast(color[name], color["stage"]) > GRAPHICS, name


def test_report_takes_the_palette_of_the_pictures() -> None:
    text = script()
    assert palette.MAPS[palette.SEQUENTIAL] in text
    assert palette.MAPS[palette.DIVERGING] in text
    assert all(color in text for color in (*palette.LINES, *palette.DARK_LINES))
