"""Pages of the site that are generated: keywords, gallery, reference, and pages of the root."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ast
import inspect
import re
from pathlib import Path

import corota as ct
from corota.io.deck.keywords import KEYWORDS

ROOT = Path(__file__).resolve().parents[1]
#: Sections of the reference, and what of the public names stands in each.
REFERENCE = {
    "Model": "Model Section Findings Amplitude Output Mesh Cells",
    "Supports and loads": "Fixed Force NodalForce EdgeLoad BodyForce Temperature InitialVelocity "
    "InitialTemperature InitialStress PointMass Dashpot",
    "Steps": "Static Dynamic Frequency Buckle ModalDynamic SteadyState ArcLength "
    "DisplacementControl",
    "Materials": "Elastic Orthotropic Expansion Mises Voce UserMaterial",
    "Contact and constraints": "RigidCurve ContactPair PressureLaw Tie Equation Coupling "
    "StraightLine LocalAxes",
    "Running and reading": "solve resume read write read_results JobFiles",
    "Sweeps": "sweep sample grid Sweep",
    "Results": "Results Frame PointFields History CriticalPoint Modes",
    "Observers": "BaseObserver Observer Iteration",
    "Errors": "CorotaError InputError DeckError ModelError UnsupportedError SingularError "
    "ConvergenceError ResourceError FileError Interrupted Diagnostic",
}
#: Modules of the reference.
MODULES = ("corota.mesh", "corota.plots", "corota.examples")
ROW = re.compile(r"^\| (`\*[^|]*?) \| ((?:[^|]|\\\|)*?) ?\| ((?:[^|]|\\\|)*?) ?\|$", re.MULTILINE)


def write(docs: Path) -> None:
    """Write all generated pages below ``docs/generated``."""
    folder = docs / "generated"
    for part in ("keywords", "gallery", "reference"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    _keywords(docs, folder / "keywords")
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
    if name == "verification/index":
        text += "\n```{toctree}\n:hidden:\n:glob:\n\n*\n```\n"
    source[0] = text


def keyword_rows(docs: Path) -> dict[str, list[tuple[str, str, str]]]:
    """Rows of the page of keywords by keyword: names, parameters, remarks."""
    text = (docs / "keywords.md").read_text(encoding="utf-8")
    found: dict[str, list[tuple[str, str, str]]] = {}
    for names, parameters, remarks in ROW.findall(text):
        for name in re.findall(r"\*([A-Z][A-Z -]*[A-Z])", names):
            up = re.sub(r"\]\(([a-z-]+\.md)", r"](../../\1", remarks)
            found.setdefault(name.replace(" ", ""), []).append((name, parameters, up))
    return found


def _keywords(docs: Path, folder: Path) -> None:
    rows = keyword_rows(docs)
    decks = {p: p.read_text(encoding="utf-8") for p in sorted((docs / "decks").glob("*.inp"))}
    pages = []
    for key, known in KEYWORDS.items():
        mine = rows.get(key, [])
        name = mine[0][0] if mine else key
        page = [f"# *{name}", ""]
        place = {"model": "before the first step", "step": "in a step", "any": "anywhere"}
        page += [f"Stands {place[known.place]}.", ""]
        for _, parameters, remarks in mine:
            page += [f"**Parameters**: {parameters or 'none'}", "", f"{remarks}.", ""]
        if not mine:
            page += ["See [the page of all keywords](../../keywords.md).", ""]
        if known.ignored:
            page += [
                "Accepted without effect, each with a note: "
                + ", ".join(f"`{w}`" for w in known.ignored.split())
                + " (written without blanks).",
                "",
            ]
        page += ["What CalculiX and Abaqus do otherwise is said above and in"]
        page += ["[the rules of all decks](../../keywords.md#rules).", ""]
        pattern = re.compile(rf"^\*{' ?'.join(name)}\s*(,|$)".replace("  ?", " ?"), re.MULTILINE)
        for path, text in decks.items():
            if pattern.search(text):
                page += ["## A deck that runs", "", f"```\n{text.rstrip()}\n```", ""]
                page += [f"`corota run {path.name}`", ""]
                break
        _put(folder / f"{key.lower()}.md", "\n".join(page))
        pages.append((name, key.lower()))
    toc = "\n".join(f"{k}" for _, k in sorted(pages))
    _put(
        folder / "index.md",
        "# Keywords, a page each\n\nThe [rules of all decks](../../keywords.md) have one page.\n\n"
        f"```{{toctree}}\n:maxdepth: 1\n\n{toc}\n```\n",
    )


def _gallery(folder: Path) -> None:
    cards = []
    for name in ct.examples.names():
        picture = folder / f"model-{name}.png"
        if not picture.exists():
            results = ct.solve(ct.examples.load(name))
            results.plot(path=picture)
        code = inspect.getsource(ct.examples.MODELS[name])
        text = ct.examples.describe(name)
        page = f"# {name.capitalize()}\n\n{text}\n\n![{name}](model-{name}.png)\n\n"
        page += f'```sh\ncorota demo {name}\n```\n\nor `ct.examples.load("{name}")`:\n\n'
        page += f"```python\n{code}```\n"
        _put(folder / f"model-{name}.md", page)
        cards.append((f"model-{name}", name.capitalize(), text, f"model-{name}.png"))
    scripts = []
    for group in sorted(p for p in (ROOT / "examples").iterdir() if p.is_dir()):
        page = f"# examples/{group.name}\n"
        for script in sorted(group.glob("*.py")):
            source = script.read_text(encoding="utf-8")
            page += f"\n## {script.name}\n\n{ast.get_docstring(ast.parse(source))}\n\n"
            page += f"```python\n{source}```\n"
        _put(folder / f"{group.name}.md", page)
        scripts.append(group.name)
    grid = "".join(
        f":::{{grid-item-card}} {title}\n:link: {page}\n:link-type: doc\n"
        f":img-top: {image}\n{text}\n:::\n\n"
        for page, title, text, image in cards
    )
    toc = "\n".join([page for page, *_ in cards] + scripts)
    _put(
        folder / "index.md",
        "# Gallery\n\nModels that come with the package; pictures are computed with this site."
        f"\n\n::::{{grid}} 1 2 3 3\n:gutter: 3\n\n{grid}::::\n\n"
        "Scripts of the repository, each run by the tests:\n\n"
        f"```{{toctree}}\n:maxdepth: 1\n\n{toc}\n```\n",
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
