"""Sphinx: the site of the documentation, built by ``make docs`` with warnings as errors."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "builder"))

import site_pages

import corota

project = "Corota"
author = "the authors of Corota"
release = version = corota.__version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_design",
    "sphinx-mathjax-offline",  # equations without a network
]
exclude_patterns = ["_build", "builder", "decks/syntax.md"]
myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence"]
myst_heading_anchors = 4
autosummary_generate = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
highlight_language = "none"
html_theme = "pydata_sphinx_theme"
html_title = "Corota"
html_favicon = "generated/static/logo.svg"
html_context = {"default_mode": "auto"}
html_static_path = ["generated/static"]
html_css_files = ["figures.css"]
html_search_scorer = str(Path(__file__).parent / "builder" / "scorer.js")
html_show_sourcelink = False
html_theme_options = {
    "logo": {
        "image_light": "generated/static/logo.svg",
        "image_dark": "generated/static/logo.svg",
        "text": "Corota",
        "alt_text": "",
    },
    "show_prev_next": True,
    "navigation_with_keys": False,
    "show_toc_level": 2,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}
copyright = "the authors of Corota, BSD-3-Clause"
# Names of pages in messages of the linter that have no page of their own.
suppress_warnings = ["myst.header"]


def setup(app: object) -> None:
    """Write the generated pages, and point links of the repository at the site."""
    site_pages.write(Path(__file__).parent)
    app.connect("source-read", site_pages.mend_links)  # type: ignore[attr-defined]
