"""One page per element: figure, facts of the core, names in decks, and a deck that runs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
from pathlib import Path

import corota as ct
from corota.io.deck.elements import ELEMENTS
from corota.model import elements

ROW = re.compile(r"^\| ((?:`[A-Z0-9]+`(?:, )?)+) \|.*$", re.MULTILINE)
LINE_DECKS = {
    "TRUSS": "`T2D2`, `T3D2` with `*SOLID SECTION`",
    "BEAM": "`B21`, `B22`, `B23`, `B31`, `B32`, `B33` with `*BEAM SECTION`",
    "SPRING": "`SPRINGA` with `*SPRING`",
    "SPRING1": "`SPRING1` with `*SPRING`, dof 1 or 2",
    "SPRING1R": "`SPRING1` with `*SPRING`, dof 6",
    "SPRING2": "`SPRING2` with `*SPRING`, dof 1 or 2",
    "SPRING2R": "`SPRING2` with `*SPRING`, dof 6",
}
PYTHON = {
    "TRUSS": "model.truss(cells, material=ct.Elastic(E=210e3), area=25.0)",
    "BEAM": "model.beam(cells, material=ct.Elastic(E=210e3), area=25.0, inertia=52.0)",
    "SPRING": "model.spring(cells, 100.0)",
    "SPRING1": 'model.spring(points, 100.0, "x")',
    "SPRING1R": 'model.spring(points, 100.0, "rotation")',
    "SPRING2": 'model.spring(cells, 100.0, "x")',
    "SPRING2R": 'model.spring(cells, 100.0, "rotation")',
}


def theory_rows(docs: Path) -> dict[str, tuple[str, str]]:
    """What an element is and what to know of it, from the table of the theory."""
    text = (docs / "theory.md").read_text(encoding="utf-8")
    found = {}
    for match in ROW.finditer(text):
        cells = [cell.strip() for cell in match.group(0).strip("|").split("|")]
        if len(cells) == 5:
            for name in re.findall(r"`([A-Z0-9]+)`", cells[0]):
                found[name] = (cells[3], cells[4])
    return found


def deck(name: str) -> str:
    """A deck of a square in pure tension, with the node order of the figure."""
    facts = elements.find(name)
    mesh = ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1, cell=facts.cell)
    lines = [f"*HEADING\nA square of {name} in tension: the stress xx is 100", "*NODE"]
    lines += [f"{i}, {x:g}, {y:g}" for i, (x, y) in enumerate(mesh.points, 1)]
    lines += [f"*ELEMENT, TYPE={name}, ELSET=part"]
    lines += [
        ", ".join(map(str, (i, *nodes + 1))) for i, nodes in enumerate(mesh.cells[0].nodes, 1)
    ]
    for side in ("left", "bottom"):
        lines += [f"*NSET, NSET={side}", ", ".join(map(str, mesh.nodes_of(side) + 1))]
    cell, face = mesh.edge_sets["right"][0] + 1
    lines += ["*SURFACE, NAME=right", f"{cell}, S{face}"]
    lines += ["*MATERIAL, NAME=steel", "*ELASTIC", "210000., 0.3"]
    lines += ["*SOLID SECTION, ELSET=part, MATERIAL=steel", "1."]
    lines += ["*BOUNDARY", "left, 1", "bottom, 2"]
    if facts.drilling:
        lines += [
            "left, 6",
            "bottom, 6",
            f"{mesh.edge_set_nodes(mesh.edge_sets['top'])[-1] + 1}, 6",
        ]
    lines += ["*STEP", "*STATIC", "*DSLOAD", "right, P, -100.", "*EL PRINT", "S"]
    return "\n".join([*lines, "*END STEP", ""])


def page(name: str, docs: Path) -> str:
    """Text of the page of an element."""
    facts = elements.find(name)
    what, know = theory_rows(docs).get(name, ("", ""))
    lines = [f"# {name}", ""]
    if what:
        lines += [f"{what[0].upper()}{what[1:]}.", ""]
    lines += [f"![Element {name}](../../figures/element_{name.lower()}.svg)", ""]
    lines += ["| fact | |", "| --- | --- |", f"| cell | `{facts.cell}` |"]
    dofs = "x, y" + (", rotation" if facts.dofs_per_node == 3 else "")
    lines += [f"| dofs of each node | {dofs} |", f"| integration points | {facts.n_points} |"]
    if facts.n_internal_modes:
        lines += [f"| internal modes, condensed | {facts.n_internal_modes} |"]
    if facts.hourglass_modes:
        lines += [f"| hourglass modes | {facts.hourglass_modes} |"]
    if not facts.line:
        free = "no" if facts.free_volume else "yes"
        lines += [f"| locks in plane strain where the volume cannot change | {free} |"]
    if facts.bending_cells:
        lines += [f"| elements through a slender part, at least | {facts.bending_cells} |"]
    if facts.line:
        decks, python = LINE_DECKS[name], PYTHON[name]
    else:
        names = [key for key, value in ELEMENTS.items() if value.element == name]
        decks = ", ".join(f"`{key}`" for key in sorted(names, key=lambda k: (k != name, k)))
        python = f'model.section("all", element="{name}", material=ct.Elastic(E=210e3, nu=0.3))'
    lines += [f"| in decks | {decks} |", f"| in Python | `{python}` |", ""]
    if know:
        lines += [f"**Know this**: {know}.", ""]
    if facts.line:
        lines += ["[Trusses, beams and springs](../../line-elements.md)", ""]
    else:
        lines += ["[Theory](../../theory.md#3-elements), "]
        lines += ["[which element?](../../decisions.md#which-element)", ""]
        lines += ["## A deck that runs", "", f"```text\n{deck(name).rstrip()}\n```", ""]
    return "\n".join(lines)


def pages(docs: Path) -> dict[str, str]:
    """Text of every page of elements, and of their index, by file name."""
    every = [*elements.names(), *elements.line_names()]
    found = {f"{name.lower()}.md": page(name, docs) for name in every}
    toc = "\n".join(name.lower() for name in every)
    found["index.md"] = (
        "# Elements, a page each\n\nThe figures are drawn from the facts of the compute core. "
        "[Which element?](../../decisions.md#which-element)\n\n"
        f"```{{toctree}}\n:maxdepth: 1\n\n{toc}\n```\n"
    )
    return found
