"""Pages of the site that are generated: keywords, gallery, reference, and pages of the root."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ast
import inspect
import re
from pathlib import Path

import element_pages
import keyword_pages
import thumbnails
from svg import STYLE

import corota as ct
from corota.model.materials import Material

DOCS = Path(__file__).resolve().parents[1]
ROOT = DOCS.parent


def is_material(value: object) -> bool:
    """Whether a public name is a class of materials."""
    return inspect.isclass(value) and issubclass(value, Material)


#: Sections of the reference, and what of the public names stands in each.
REFERENCE = {
    "Model": "Model Section Findings Amplitude Output Mesh Cells",
    "Supports and loads": "Fixed Force NodalForce EdgeLoad BodyForce Temperature InitialVelocity "
    "InitialTemperature InitialStress PointMass Dashpot",
    "Steps": "Static Dynamic Frequency Buckle ModalDynamic SteadyState ArcLength "
    "DisplacementControl",
    "Materials": " ".join(
        ["Expansion", "Voce", *(n for n in ct.__all__ if is_material(getattr(ct, n)))]
    ),
    "Contact and constraints": "RigidCurve ContactPair PressureLaw Tie Equation Coupling "
    "StraightLine LocalAxes",
    "Running and reading": "solve resume read write read_results JobFiles",
    "Sweeps": "sweep sample grid Sweep seek Sought",
    "Selections": "near on_line on_circle inside",
    "Results": "Results BodyMotion Frame PointFields History CriticalPoint Modes",
    "Observers": "BaseObserver Observer Iteration",
    "Errors": "CorotaError InputError DeckError ModelError UnsupportedError SingularError "
    "ConvergenceError ResourceError FileError Interrupted Diagnostic",
}
#: Pictures of cards have one height.
CARDS = (
    ".sd-card-img-top{height:11rem;object-fit:contain;background:#fff;padding:.4rem}"
    ".bd-article figure{margin:1rem 0}"
)
#: Modules of the reference.
MODULES = ("corota.mesh", "corota.plots", "corota.examples")
FIGURE = re.compile(r"!\[([^\]]*)\]\((?:\.\./)*figures/([a-z0-9_]+)\.svg\)")


def write(docs: Path) -> None:
    """Write all generated pages below ``docs/generated``."""
    folder = docs / "generated"
    for part in ("keywords", "elements", "gallery", "reference", "static"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    _put(folder / "static" / "figures.css", STYLE + CARDS)
    for part, pages in (("keywords", keyword_pages.pages), ("elements", element_pages.pages)):
        for name, text in pages(docs).items():
            _put(folder / part / name, text)
    _gallery(folder / "gallery")
    _reference(folder / "reference")
    for name in ("CHANGELOG", "CONTRIBUTING"):
        text = (ROOT / f"{name}.md").read_text(encoding="utf-8")
        _put(folder / f"{name.lower()}.md", text.replace("](docs/", "](../"))
    cite = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    _put(folder / "cite.md", f"# How to cite\n\n```yaml\n{cite}\n```\n")


def mend_links(app: object, name: str, source: list[str]) -> None:
    """Point links that leave the folder of documents at the pages of the site."""
    up = "../" * name.count("/")
    here = f"{up}generated/" if not name.startswith("generated/") else up + "generated/"
    text = source[0]
    text = re.sub(r"\]\((?:\.\./)+CONTRIBUTING\.md", f"]({here}contributing.md", text)
    text = re.sub(
        r"\[([^\]]*)\]\((?:\.\./)+examples/([^)/]+)[^)]*\)", rf"[\1]({here}gallery/\2.md)", text
    )
    text = re.sub(r"\[([^\]]*)\]\((?:\.\./)+(?:benchmarks|tests|src|rust)[^)]*\)", r"\1", text)
    if name.startswith("generated/"):
        text = re.sub(r"\[([^\]]*)\]\((?!http)[^)]*(?:rust|src|tests)/[^)]*\)", r"\1", text)
    text = FIGURE.sub(inline_figure, text)
    if name == "verification/index":
        text += "\n```{toctree}\n:hidden:\n:glob:\n\n*\n```\n"
    source[0] = text


def inline_figure(match: re.Match[str]) -> str:
    """A figure as part of the page, so that it follows the page's light or dark colors."""
    figure = (DOCS / "figures" / f"{match.group(2)}.svg").read_text(encoding="utf-8")
    figure = re.sub(r"<style>.*?</style>\n", "", figure, flags=re.DOTALL)
    return f"```{{raw}} html\n<figure>\n{figure}</figure>\n```"


def _gallery(folder: Path) -> None:
    models = []
    for name in ct.examples.names():
        picture = folder / f"model-{name}.png"
        if not picture.exists():
            thumbnails.draw(ct.solve(ct.examples.load(name)), picture, 110)
        code = inspect.getsource(ct.examples.MODELS[name])
        text = ct.examples.describe(name)
        page = f"# {name.capitalize()}\n\n{text}\n\n![{name}](model-{name}.png)\n\n"
        page += f'```sh\ncorota demo {name}\n```\n\nor `ct.examples.load("{name}")`:\n\n'
        page += f"```python\n{code}```\n"
        _put(folder / f"model-{name}.md", page)
        models.append(_card(f"model-{name}", name.capitalize(), text, f"model-{name}.png"))
    scripts, groups = [], []
    for group in sorted(p for p in (ROOT / "examples").iterdir() if p.is_dir()):
        page = f"# examples/{group.name}\n"
        for script in sorted(group.glob("*.py")):
            source = script.read_text(encoding="utf-8")
            text = ast.get_docstring(ast.parse(source)) or ""
            page += f"\n## {script.name}\n\n{text}\n\n"
            picture = thumbnails.FOLDER / thumbnails.name(script)
            if picture.exists():
                image = f"../../images/gallery/{picture.name}"
                page += f"![{script.stem}]({image})\n\n"
                title = script.stem.replace("_", " ").capitalize()
                scripts.append(_card(group.name, title, text.split("\n\n")[0], image))
            page += f"```python\n{source}```\n"
        _put(folder / f"{group.name}.md", page)
        groups.append(group.name)
    toc = "\n".join([*(f"model-{name}" for name in ct.examples.names()), *groups])
    _put(
        folder / "index.md",
        "# Gallery\n\nModels that come with the package; the pictures show the largest stress."
        f"\n\n::::{{grid}} 1 2 3 3\n:gutter: 3\n\n{''.join(models)}::::\n\n"
        "## Scripts\n\nExamples of the repository, each run by the tests."
        f"\n\n::::{{grid}} 1 2 3 3\n:gutter: 3\n\n{''.join(scripts)}::::\n\n"
        f"```{{toctree}}\n:hidden:\n\n{toc}\n```\n",
    )


def _card(page: str, title: str, text: str, image: str) -> str:
    return (
        f":::{{grid-item-card}} {title}\n:link: {page}\n:link-type: doc\n"
        f":img-top: {image}\n{' '.join(text.split())}\n:::\n\n"
    )


def _reference(folder: Path) -> None:
    names = []
    for title, listed in REFERENCE.items():
        page = f"# {title}\n"
        for name in listed.split():
            value = getattr(ct, name)
            home = f"{value.__module__}.{name}"
            kind = "autoclass" if inspect.isclass(value) else "autofunction"
            members = (
                "\n:members:\n:inherited-members: Exception, list" if kind == "autoclass" else ""
            )
            page += f"\n## {name}\n\n```{{eval-rst}}\n.. {kind}:: {home}\n"
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
            if inspect.isfunction(value):
                page += f"\n## {name}\n\n```{{eval-rst}}\n.. autofunction:: {module}.{name}\n```\n"
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
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
