"""Pages of the site that are generated: keywords, gallery, reference, and pages of the root."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import inspect
import re
from pathlib import Path

import deck_pictures
import element_pages
import gallery
import keyword_pages
import search
from svg import STYLE

import corota as ct
from corota.model.hyperelastic import Hyperelastic
from corota.model.materials import Material

DOCS = Path(__file__).resolve().parents[1]
ROOT = DOCS.parent


def is_material(value: object) -> bool:
    """Whether a public name is a class of materials."""
    return inspect.isclass(value) and issubclass(value, Material)


#: Names of materials, and those of rubber and polymers among them.
MATERIALS = [name for name in ct.__all__ if is_material(getattr(ct, name))]
RUBBER = [
    name
    for name in MATERIALS
    if issubclass(getattr(ct, name), Hyperelastic) or name in ("Mullins", "Viscoelastic")
]
#: Sections of the reference, and what of the public names stands in each.
REFERENCE = {
    "Model": "Model Section Findings Amplitude Output Mesh Cells",
    "Supports and loads": "Fixed Force NodalForce EdgeLoad BodyForce Temperature InitialVelocity "
    "InitialTemperature InitialStress PointMass Dashpot",
    "Steps": "Static Visco Dynamic Frequency Buckle ModalDynamic SteadyState ArcLength "
    "DisplacementControl",
    "Materials": " ".join(
        ["Expansion", "Voce", "CowperSymonds", "YieldRatio", "RateCurves", "Norton"]
        + [n for n in MATERIALS if n not in RUBBER]
    ),
    "Rubber materials": " ".join(["WLF", *RUBBER]),
    "Contact and constraints": "RigidCurve ContactPair PressureLaw DecayingFriction FrictionTable "
    "gap_element Tie Equation Coupling StraightLine LocalAxes",
    "Running and reading": "solve resume read write read_results JobFiles",
    "Sweeps": "sweep sample grid Sweep seek Sought",
    "Gradients of a run": "gradient value_and_grad optimize shape",
    "Periodic cells": "PeriodicCell",
    "Selections": "near on_line on_circle inside",
    "Results": "Results BodyMotion Frame PointFields History CriticalPoint Modes",
    "Observers": "BaseObserver Observer Iteration",
    "Errors": "CorotaError InputError DeckError ModelError UnsupportedError SingularError "
    "ConvergenceError ResourceError FileError Interrupted Diagnostic",
}
#: Colors of the theme, pictures of cards, and the width of articles.
LOOK = (
    "html[data-theme=light]{--pst-color-primary:#0b6392;--pst-color-secondary:#b23c17}"
    "html[data-theme=dark]{--pst-color-primary:#66bfe8;--pst-color-secondary:#ff9d70}"
    ".bd-sidebar-primary{flex:0 0 15rem}.bd-sidebar-secondary{flex:0 0 13rem}"
    ".bd-main .bd-content .bd-article-container{max-width:62rem}"
    ".bd-article table{font-size:.82rem}.bd-article :is(td,th){padding:.25rem .4rem}"
    ".bd-article table:has(th:nth-child(8)){font-size:.7rem}"
    ".bd-article table:has(th:nth-child(14)){font-size:.6rem}"
    ".bd-article table:has(th:nth-child(14)) :is(td,th){padding:.2rem .15rem}"
    ".bd-header-article .ellipsis{white-space:normal}"
    ".sd-card-img-top{height:11rem;object-fit:contain;background:#fff;padding:.4rem}"
    ".bd-article figure{margin:1rem 0}"
    ".filter{display:flex;flex-wrap:wrap;gap:.4rem;margin:1rem 0}.filter button{border:1px solid "
    "var(--pst-color-border);border-radius:1rem;padding:.15rem .8rem;background:none;color:inherit}"
    ".filter button[aria-pressed=true]{background:var(--pst-color-primary);"
    "color:var(--pst-color-background)}"
    # Code and tables wrap; nothing is hidden at the right.
    ".bd-article pre{white-space:pre-wrap;overflow-wrap:anywhere}"
    ".bd-article td :is(code,.pre){white-space:normal;overflow-wrap:anywhere}"
    ".prev-next-footer a,.prev-next-info,.prev-next-title{overflow:visible;white-space:normal}"
)
#: Modules of the reference.
MODULES = (
    "corota.mesh",
    "corota.plots",
    "corota.examples",
    "corota.gradients",
    "corota.cells",
    "corota.profiles",
)
#: Pages of the repository that have a place in the site.
ROOT_PAGES = {
    "changelog": "CHANGELOG.md",
    "contributing": "CONTRIBUTING.md",
    "benchmarks": "benchmarks/README.md",
}
#: The mark of the project: a strip that bends, and the frame that turns with it.
LOGO = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 32 32">'
    '<rect width="32" height="32" rx="6" fill="#0b6392"/>'
    '<path d="M5 25C14 25 20 21 22 12" fill="none" stroke="#fff" stroke-width="4"/>'
    '<path d="M17 4l8 2-2 8-8-2z" fill="none" stroke="#ffb37a" stroke-width="2.4"/></svg>'
)
#: Pages written by this run.
WRITTEN: set[Path] = set()
EXAMPLE = re.compile(r"\[([^\]]*)\]\((?:\.\./)+examples/([^)]+?)/?\)")
FIGURE = re.compile(r"!\[([^\]]*)\]\((?:\.\./)*figures/([a-z0-9_]+)\.svg\)")


def write(docs: Path) -> None:
    """Write all generated pages below ``docs/generated``."""
    folder = docs / "generated"
    for part in ("keywords", "elements", "gallery", "reference", "static"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    _put(folder / "static" / "figures.css", STYLE + LOOK)
    _put(folder / "static" / "logo.svg", LOGO)
    deck_pictures.write(docs / "decks", folder / "static")
    for part, pages in (("keywords", keyword_pages.pages), ("elements", element_pages.pages)):
        for name, text in pages(docs).items():
            _put(folder / part / name, text)
    for name, text in gallery.pages().items():
        _put(folder / "gallery" / name, text)
    _reference(folder / "reference")
    for name, source in ROOT_PAGES.items():
        text = (ROOT / source).read_text(encoding="utf-8")
        _put(folder / f"{name}.md", _moved(text))
    cite = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    _put(folder / "cite.md", f"# How to cite\n\n```yaml\n{cite}\n```\n")
    for path in set(folder.rglob("*.md")) - WRITTEN:  # of a builder before this one
        path.unlink()


def _moved(text: str) -> str:
    """The text of a page of the repository with its links seen from the generated pages."""
    text = re.sub(r"\]\((?:\.\./)?docs/", "](../", text)
    return text.replace("](images/", "](../../benchmarks/images/")


def mend_links(app: object, name: str, source: list[str]) -> None:
    """Point links that leave the folder of documents at the pages of the site."""
    up = "../" * name.count("/")
    here = f"{up}generated/" if not name.startswith("generated/") else up + "generated/"
    text = source[0]
    for page in ("CONTRIBUTING", "CHANGELOG"):
        text = re.sub(rf"\]\((?:\.\./)*{page}\.md", f"]({here}{page.lower()}.md", text)
    text = re.sub(r"\]\((?:\.\./)+benchmarks/README\.md", f"]({here}benchmarks.md", text)
    text = EXAMPLE.sub(lambda m: f"[{m[1]}]({here}gallery/{gallery.page_name(m[2])}.md)", text)
    text = re.sub(r"\[([^\]]*)\]\((?:\.\./)+(?:benchmarks|tests|src|rust)[^)]*\)", r"\1", text)
    if name.startswith("generated/"):
        text = re.sub(r"\[([^\]]*)\]\((?!http)[^)]*(?:rust|src|tests)/[^)]*\)", r"\1", text)
    text = FIGURE.sub(inline_figure, text)
    text = gallery.with_examples(name, search.with_words(name, text))
    if name == "verification/index":
        text += "\n```{toctree}\n:hidden:\n:glob:\n\n*\n```\n"
    source[0] = text


def inline_figure(match: re.Match[str]) -> str:
    """A figure as part of the page, so that it follows the page's light or dark colors."""
    figure = (DOCS / "figures" / f"{match.group(2)}.svg").read_text(encoding="utf-8")
    figure = re.sub(r"<style>.*?</style>\n", "", figure, flags=re.DOTALL)
    return f"```{{raw}} html\n<figure>\n{figure}</figure>\n```"


def _reference(folder: Path) -> None:
    names = []
    for title, listed in REFERENCE.items():
        page = f"# {title}\n"
        for name in listed.split():
            value = getattr(ct, name)
            kind = "autoclass" if inspect.isclass(value) else "autofunction"
            members = (
                "\n:members:\n:inherited-members: Exception, list" if kind == "autoclass" else ""
            )
            page += f"\n## {name}\n\n```{{eval-rst}}\n.. {kind}:: corota.{name}\n"
            page += "".join(f"   {line}\n" for line in members.split("\n") if line) + "```\n"
        key = title.lower().replace(" ", "-")
        _put(folder / f"{key}.md", page)
        names.append(key)
    for module in MODULES:
        key = module.split(".")[1]
        public = __import__(module, fromlist=["x"])
        page = f"# {module}\n\n```{{eval-rst}}\n.. automodule:: {module}\n```\n"
        for name in getattr(public, "__all__", []):
            value = getattr(public, name)
            if name in ct.__all__:
                continue
            if inspect.isfunction(value):
                page += f"\n## {name}\n\n```{{eval-rst}}\n.. autofunction:: {module}.{name}\n```\n"
            elif inspect.isclass(value):
                page += f"\n## {name}\n\n```{{eval-rst}}\n.. autoclass:: {module}.{name}\n```\n"
        _put(folder / f"{key}.md", page)
        names.append(key)
    toc = "\n".join(names)
    _put(
        folder / "index.md",
        "# Python reference\n\nAll names stand under `corota`: `import corota as ct`.\n\n"
        f"```{{toctree}}\n:maxdepth: 2\n\n{toc}\n```\n",
    )


def _put(path: Path, text: str) -> None:
    """Write a page where it has changed, so that Sphinx builds only what is new."""
    WRITTEN.add(path)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
