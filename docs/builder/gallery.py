"""The gallery: a page for each example, cards by topic, links between examples and topics."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ast
import inspect
import json
from dataclasses import dataclass
from pathlib import Path

import example_runs
import thumbnails

import corota as ct

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
#: Topics, and the pages that explain them.
TOPICS = {
    "Flexures": ("howto/flexure", "constraints"),
    "Snap-fits and seals": ("howto/snap_fit", "howto/seal"),
    "Contact": ("contact",),
    "Buckling and snap-through": ("howto/bistable_switch", "paths"),
    "Plasticity": ("plasticity", "howto/cyclic_plasticity"),
    "Motion and impact": ("dynamics", "impact", "howto/impact"),
    "Beams": ("line-elements", "howto/beams_on_plates"),
    "Elements": ("comparison", "theory"),
    "Periodic cells": ("cells",),
    "More": ("howto/index",),
}


@dataclass(frozen=True)
class Entry:
    """An example: its topic, its numbers beside the independent ones, its model in the package."""

    topic: str
    numbers: str = ""
    model: str = ""


#: Examples by their path below ``examples``.
ENTRIES = {
    "cells/chiral": Entry(
        "Periodic cells", "Bulk modulus over that by hand: 1.000000000000; Poisson's ratio -0.990."
    ),
    "cells/holes": Entry(
        "Periodic cells", "Onset by one cell over that by the path of 2 x 2 cells: 1.00000000."
    ),
    "cells/squares": Entry(
        "Periodic cells",
        "Closing strain by hand 0.410985; stress just after it over that by hand: 1.0000.",
    ),
    "contact/bistable_beam": Entry(
        "Buckling and snap-through",
        "The probe's force vanishes after 4/3 of the height within 2 % (Qiu, Lang, Slocum).",
    ),
    "contact/clip": Entry("Snap-fits and seals", model="clip"),
    "contact/crushed_ring": Entry("Contact"),
    "contact/hertz": Entry(
        "Contact", "Pressure and half width over those of Hertz: 1.001 and 1.000 with `Q4I`."
    ),
    "contact/ironing": Entry("Contact"),
    "contact/seal": Entry("Snap-fits and seals", model="seal"),
    "contact/snap_by_load": Entry("Buckling and snap-through"),
    "cook/cook": Entry(
        "Elements",
        "Tip of the linear membrane with `Q9`, 16 x 16: 23.949; converged 23.966, the same mesh in "
        "an independent code 23.949.",
    ),
    "constant_force/constant_force": Entry("Flexures"),
    "cyclic_strip/cyclic_strip": Entry("Plasticity"),
    "disc_spring/disc_spring": Entry(
        "Buckling and snap-through",
        "Friction changes the force by 1.0137 and .9821; statics of its edges 1.0136 and .9823.",
    ),
    "flexure/flexure": Entry("Flexures", model="hinge"),
    "frame_on_plate/frame_on_plate": Entry("Beams"),
    "frames/frames": Entry("Beams"),
    "gripper/gripper": Entry("Flexures", model="gripper"),
    "guide/guide": Entry("Flexures"),
    "imperfections/imperfections": Entry("Buckling and snap-through"),
    "impact/bar": Entry("Motion and impact"),
    "impact/ring": Entry("Motion and impact"),
    "limit_load/limit_load": Entry("Plasticity"),
    "inverter/inverter": Entry("Flexures"),
    "joints/joints": Entry("Flexures"),
    "lines/frame_stop": Entry("Beams"),
    "motion/cantilever_sine": Entry("Motion and impact"),
    "motion/free_flight": Entry("Motion and impact"),
    "motion/pendulum": Entry("Motion and impact"),
    "motion/pulse": Entry("Motion and impact"),
    "motion/rotor": Entry("Motion and impact"),
    "o_ring/o_ring": Entry(
        "Snap-fits and seals",
        "The wall carries the fluid between its fronts within 1e-6; the ring stays tight.",
    ),
    "perforated_strip/perforated_strip": Entry("Plasticity"),
    "plastic_cook/plastic_cook": Entry("Plasticity"),
    "portal/portal": Entry(
        "Beams", "Load over that of the mechanism with four hinges: 0.9962 (axial forces)."
    ),
    "rollup/rollup": Entry(
        "Elements", "The gap of the closed circle over its length: 0.0007; exact 0.", "rollup"
    ),
    "snap_fit/annular": Entry(
        "Snap-fits and seals",
        "On the land 600 N; a shell on an elastic foundation 604 N, CalculiX 592 N.",
    ),
    "snap_fit/snap_fit": Entry("Snap-fits and seals"),
    "taylor_bar/taylor_bar": Entry(
        "Motion and impact",
        "Length 26.55, diameter of the foot 11.15; Abaqus 26.56, 11.16, DynELA 26.52, 11.15.",
    ),
    "switch/switch": Entry("Buckling and snap-through", model="bistable"),
}
for _script in thumbnails.scripts():  # those that nobody has put under a topic yet
    ENTRIES.setdefault(_script.relative_to(EXAMPLES).with_suffix("").as_posix(), Entry("More"))
#: The filter: a button shows the cards of its topic only.
FILTER = """```{{raw}} html
<div class="filter" role="group" aria-label="Topics">{buttons}</div>
<script>
document.querySelector(".filter").addEventListener("click", ({{ target }}) => {{
  if (target.tagName !== "BUTTON") return;
  for (const button of target.parentElement.children)
    button.setAttribute("aria-pressed", String(button === target));
  for (const card of document.querySelectorAll("article .sd-col"))
    card.hidden = Boolean(target.value) && !card.querySelector(`.${{target.value}}`);
}});
</script>
```
"""


def key(topic: str) -> str:
    """A topic as a class of styles."""
    return "topic-" + topic.split()[0].lower()


def page_name(path: str) -> str:
    """Page of an example, or of a folder with one example: ``contact-clip``, ``guide``."""
    group, _, stem = path.removesuffix(".py").partition("/")
    alone = sum(other.startswith(f"{group}/") for other in ENTRIES) == 1
    if alone:
        return group
    return f"{group}-{stem}" if stem else "index"


def pages() -> dict[str, str]:
    """Text of every page of the gallery by file name."""
    found = {f"{page_name(path)}.md": page(path, entry) for path, entry in ENTRIES.items()}
    found |= {f"notebook-{file.stem}.md": notebook(file) for file in NOTEBOOKS}
    cells = "".join(
        f"- [{text.partition(chr(10))[0].removeprefix('# ')}]({name})\n"
        for name, text in found.items()
        if name.startswith("notebook-")
    )
    cards = "".join(card(path, entry) for path, entry in ENTRIES.items())
    buttons = '<button value="" aria-pressed="true">All</button>' + "".join(
        f'<button value="{key(topic)}" aria-pressed="false">{topic}</button>'
        for topic in TOPICS
        if any(entry.topic == topic for entry in ENTRIES.values())
    )
    toc = "\n".join(name.removesuffix(".md") for name in found)
    found["index.md"] = (
        "# Gallery\n\nEach example is run by the tests; its page has its text, what it prints "
        "beside the independent values, and its time. The pictures show the frame of the largest "
        "von Mises stress: pale is none, dark the largest.\n\n"
        + FILTER.format(buttons=buttons)
        + f"\n::::{{grid}} 1 2 3 3\n:gutter: 3\n\n{cards}::::\n\n"
        f"## Notebooks\n\nIn cells, step by step; the tests run them as they are.\n\n{cells}\n"
        f"```{{toctree}}\n:hidden:\n\n{toc}\n```\n"
    )
    return found


def notebook(file: Path) -> str:
    """A notebook as a page: its texts and cells in order."""
    cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
    texts = ["".join(cell["source"]).rstrip() for cell in cells]
    parts = [
        text if cell["cell_type"] == "markdown" else f"```python\n{text}\n```"
        for cell, text in zip(cells, texts, strict=True)
    ]
    note = f"`notebooks/{file.name}` of the repository; it runs as it is."
    heading, _, rest = "\n\n".join(parts).partition("\n")
    return f"{heading}\n\n{note}\n{rest}\n"


def title(path: str) -> str:
    """Name of an example."""
    return path.split("/")[1].replace("_", " ").capitalize()


def text_of(path: str) -> str:
    """What the script says of itself."""
    return ast.get_docstring(ast.parse((EXAMPLES / f"{path}.py").read_text(encoding="utf-8"))) or ""


def picture(path: str) -> str:
    """Picture of an example as the pages of the gallery see it; empty where there is none."""
    file = thumbnails.FOLDER / thumbnails.name(EXAMPLES / f"{path}.py")
    return f"../../images/gallery/{file.name}" if file.exists() else ""


def card(path: str, entry: Entry) -> str:
    """Card of an example."""
    first = " ".join(text_of(path).split("\n\n")[0].split())
    image = picture(path)
    top = f":img-top: {image}\n:img-alt: {title(path)}\n" if image else ""
    return (
        f":::{{grid-item-card}} {title(path)}\n:link: {page_name(path)}\n:link-type: doc\n"
        f":class-card: {key(entry.topic)}\n{top}\n{first}\n:::\n\n"
    )


def page(path: str, entry: Entry) -> str:
    """Page of an example: what it shows, its numbers, how to run it, its text."""
    file = EXAMPLES / f"{path}.py"
    lines = [f"# {title(path)}", "", text_of(path), ""]
    if image := picture(path):
        lines += [f"![{title(path)}]({image})", ""]
    if entry.numbers:
        lines += [f"**Beside the independent value**: {entry.numbers}", ""]
    links = ", ".join(f"[{name.split('/')[-1].replace('_', ' ')}](../../{name}.md)"
                      for name in TOPICS[entry.topic])  # fmt: skip
    lines += [f"**{entry.topic}**: {links}", "", "```sh", f"python examples/{path}.py"]
    run = example_runs.stored().get(path)
    decks = sorted(p.name for p in file.parent.glob("*.inp") if not p.stem.endswith("_mesh"))
    lines += [f"corota run examples/{file.parent.name}/{deck}" for deck in decks]
    if entry.model:
        lines += [f"corota demo {entry.model}"]
    lines += ["```", ""]
    if run:  # of a new example there is none yet
        lines += [f"It takes {run['seconds']:g} s of one core and prints:", ""]
        lines += ["```text", *run["printed"], "```", ""]  # type: ignore[misc]
    if entry.model:
        code = inspect.getsource(ct.examples.MODELS[entry.model])
        lines += [
            f'A model of this kind comes with the package, `ct.examples.load("{entry.model}")`:'
        ]
        lines += ["", "```python", code.rstrip(), "```", ""]
    lines += [f"## {file.name}", "", "```python", file.read_text(encoding="utf-8").rstrip(), "```"]
    return "\n".join(lines) + "\n"


def with_examples(name: str, text: str) -> str:
    """The text of a page with links to the examples of its topics at its end."""
    topics = [topic for topic, names in TOPICS.items() if name in names]
    found = [path for path, entry in ENTRIES.items() if entry.topic in topics]
    if not found:
        return text
    up = "../" * name.count("/")
    links = ", ".join(
        f"[{title(path).lower()}]({up}generated/gallery/{page_name(path)}.md)" for path in found
    )
    return f"{text.rstrip()}\n\nExamples with their pictures: {links}.\n"


__all__ = ["ENTRIES", "TOPICS", "page_name", "pages", "with_examples"]
