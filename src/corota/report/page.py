"""Assembly of the page from its parts: template, styles, scripts, vendored library, data."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import base64
import json
import re
from functools import lru_cache
from html import escape
from importlib.resources import files
from typing import TYPE_CHECKING

from corota.plots import palette

if TYPE_CHECKING:
    from corota.report.content import Content

#: Modules of the page; each imports only those before it.
MODULES = (
    "dom", "chunk", "colors", "geometry", "fields", "source", "model", "scene", "painter",
    "overlay", "revolved", "player", "history", "axes", "charts", "tables", "live", "main",
)  # fmt: skip
#: Content security policy: only the page's own scripts; a live page may also request its server.
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; connect-src {connect}; base-uri 'none'; form-action 'none'"
)

#: Place of the palette in the module of colors.
_PALETTE = "/* of corota.plots.palette */ {}"
_IMPORT = re.compile(r'^import (\{[^}]*\}) from "\./(\w+)\.js";$', re.MULTILINE)
_EXPORT = re.compile(r"^export ((?:async )?(?:function\*?|class|const|let) (\w+))", re.MULTILINE)


def asset(name: str) -> str:
    """Text of a part of the page."""
    return (files("corota.report") / "assets" / name).read_text(encoding="utf-8")


@lru_cache(maxsize=1)
def script() -> str:
    """All modules as one script, each a function that returns what it exports."""
    return "const modules = {};\n" + "\n".join(_wrapped(name) for name in MODULES)


def _wrapped(name: str) -> str:
    """A module with imports and exports through the object ``modules``."""
    text = asset(f"{name}.js").replace(_PALETTE, _colors())
    exported = [found[2] for found in _EXPORT.finditer(text)]
    text = _IMPORT.sub(r"const \1 = modules.\2;", text)
    text = _EXPORT.sub(r"\1", text)
    return (
        f"modules.{name} = (() => {{\n{text.strip()}\nreturn {{ {', '.join(exported)} }};\n}})();"
    )


def _colors() -> str:
    """The palette of the pictures for scripts."""
    lines = {"light": palette.LINES, "dark": palette.DARK_LINES}
    return json.dumps(
        {
            "maps": palette.MAPS,
            "sequential": palette.SEQUENTIAL,
            "diverging": palette.DIVERGING,
            "negative": palette.NEGATIVE,
            "positive": palette.POSITIVE,
            "oneSign": palette.ONE_SIGN,
            "lines": lines,
        }
    )


def page(content: Content | None, *, title: str = "", live: str = "") -> str:
    """Text of a page.

    Parameters
    ----------
    content : Content or None
        Content; None for a live page, which requests it from its server.
    title : str
        Heading of a live page.
    live : str
        Path of the server for the requests of a live page.
    """
    data = ""
    if content is not None:
        title = content.title
        data = "\n".join(
            f'<script type="application/x-corota" data-chunk="{name}">'
            f"{base64.b64encode(chunk).decode('ascii')}</script>"
            for name, chunk in content.chunks.items()
        )
    parts = {
        "policy": POLICY.format(connect="'self'" if live else "'none'"),
        "title": escape(title),
        "live": escape(live),
        "style": asset("vendor/uPlot.min.css") + asset("style.css"),
        "library": _inside(asset("vendor/uPlot.iife.min.js")),
        "script": _inside(script()),
        "data": data,
    }
    # One pass, so that text inside a part is not replaced.
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], asset("page.html"))


def _inside(text: str) -> str:
    """Text of a script that does not end the element it stands in."""
    return text.replace("</script", "<\\/script")
