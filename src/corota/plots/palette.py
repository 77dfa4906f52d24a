"""Colors of pictures, reports and site, clear to color-blind readers on their ground."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from functools import lru_cache
from typing import Any

#: Maps of fields, as 33 stops each (ColorBrewer's YlOrRd and RdBu, viridis, cividis).
MAPS = {
    "heat": (
        "ffffccfffac1fff6b6fff1abffeda0ffe895fee38bfede80fed976fecf6bfec561febb56feb24cfea848"
        "fd9f44fd9640fd8c3cfd7c37fc6c33fc5d2efc4d2af54026ef3323e9261fe2191cd9131fcf0c21c50624"
        "bb0026ac00269d00268d0026800026"
    ),
    "diverging": (
        "0530610e41791752901f63a82a71b23480b93f8ec0529dc86bacd184bcd99bc9e0aed3e6c2ddecd4e6f1"
        "e0ecf3ecf2f5f7f6f6f9eee7fbe5d8fddcc9fbccb4f8bb9ef5aa89ee9677e48066db6b55d05548c53e3d"
        "ba2832ab162a930e267c072267001f"
    ),
    "viridis": (
        "440154470d6048186a482374472d7b4537814240863e49893b528b375b8d33638d2f6b8e2c728e297a8e"
        "26828e23898e21918c1f988b1fa08822a78528ae8032b67a3fbc734ec36b5ec96270cf5784d44b98d83e"
        "addc30c2df23d8e219ece51bfde725"
    ),
    "cividis": (
        "00224e00285b002e6a0533711a386f273e6e32436d3b496c434e6c4b546c535a6d5a5f6e61656f686a71"
        "6f70737676767d7c788482798c8878938e789b9476a39a74aba072b4a76fbcae6cc4b468cdbb63d5c25e"
        "dec958e7d150f0d846f9e03afee838"
    ),
}
#: For values of one sign, pale for small ones; for values of both signs, white at zero.
SEQUENTIAL, DIVERGING = "heat", "diverging"
#: Its sides, for signed values that all have one sign: red is positive, pale near zero.
NEGATIVE, POSITIVE = "negative", "positive"
MAPS[NEGATIVE], MAPS[POSITIVE] = MAPS[DIVERGING][: 6 * 16], MAPS[DIVERGING][6 * 17 :]
#: Values of the other sign that are smaller than this share of the largest size do not count.
ONE_SIGN = 0.02
#: Colors of lines on white, and of the page with a dark ground, in this order.
LINES = ("#0072b2", "#d55e00", "#009e73", "#a03a86", "#5b4700", "#3d9bdf", "#2b2f36")
DARK_LINES = ("#56b4e9", "#ff8a3d", "#1f9d76", "#f3b8dc", "#ffe27a", "#5577ff", "#ffffff")
#: Grounds that these lines stand on.
GROUND, DARK_GROUND = "#ffffff", "#1a2029"


def map_of(low: float, high: float, signed: bool) -> str:
    """Name of the map for values between two limits, of a variable that may be negative or not."""
    if not signed:
        return SEQUENTIAL
    size = max(abs(low), abs(high))
    if low < -ONE_SIGN * size and high > ONE_SIGN * size:
        return DIVERGING
    return NEGATIVE if low + high < 0.0 else POSITIVE


def stops(name: str) -> list[str]:
    """Colors of a map at equal distances, as ``#rrggbb``."""
    text = MAPS[name]
    return [f"#{text[i : i + 6]}" for i in range(0, len(text), 6)]


@lru_cache
def colormap(name: str) -> Any:
    """A map as one of matplotlib."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list(name, stops(name))
