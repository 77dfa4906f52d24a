"""Small decks of several steps that try what a step keeps, changes and takes away.

Each deck is made from its number alone: a cantilever strip of four elements and one to four steps
with loads of all cards, ``OP``, amplitudes, sets that name the same nodes and edges, ``NLGEOM``
and procedures drawn at random. A deck that CalculiX refuses is not made: two amplitudes on one
load in a step, loads that a procedure does not take.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from random import Random
from typing import TYPE_CHECKING

import corota as ct

if TYPE_CHECKING:
    from collections.abc import Sequence

#: Decks of the family.
COUNT = 400
THEMES = (
    "forces",
    "edges",
    "bodies",
    "supports",
    "temperatures",
    "mixed",
    "large rotations",
    "motion",
    "frequencies",
    "buckling",
    "modal",
)
#: Themes with full integration: CalculiX's reduced bricks have another mass, and half the geometric
#: stiffness (Euler's column buckles at twice the load).
FULL = ("motion", "frequencies", "buckling", "modal")
#: Length of the strip and elements along it.
LENGTH, CELLS = 4.0, 4
#: Node sets by name, as places; element sets, as numbers.
NODE_SETS = {"LEFT": "left", "RIGHT": "right", "TOP": "top", "EVERY": "all"}
ELEMENT_SETS = {"HALF": (3, 4), "SAME": (3, 4), "ONE": (3,), "ALSO": (1, 2, 3, 4)}
#: Surfaces: element set and side.
SURFACES = {"LID": ("EALL", 3), "PART": ("HALF", 3), "COVER": ("ALSO", 3), "FLOOR": ("EALL", 1)}
#: Amplitudes: step time and total time.
TABLES = {
    "LOCAL": ("STEP TIME", "0., 0., .3, 1., .8, .6"),
    "SECOND": ("STEP TIME", "0., .2, .5, .9, 1., 1.3"),
    "TOTAL": ("TOTAL TIME", "0., 0., .5, .7, 1.2, .4, 2.3, 1.1"),
    "LONG": ("TOTAL TIME", "0., .5, 3., 2., 4., 1."),
}
RUNS_ON = ("TOTAL", "LONG")


@dataclass
class Deck:
    """A generated deck.

    Parameters
    ----------
    number : int
    theme : str
    text : str
    ends : list of float
        Total time at the end of every step that has one; perturbations have none.
    features : set of str
        What it holds that exceptions are known by.
    tolerance : float
        Largest difference, relative to the largest value of its kind.
    """

    number: int
    theme: str
    text: str
    ends: list[float] = field(default_factory=list)
    features: set[str] = field(default_factory=set)
    tolerance: float = 2e-5


@dataclass
class _Writer:
    """State while a deck is written."""

    random: Random
    slender: bool
    bodies: dict[tuple[object, ...], str] = field(default_factory=dict)
    heated: dict[str, str] = field(default_factory=dict)
    features: set[str] = field(default_factory=set)
    pressed: bool = False  # whether a step before has loads on edges
    #: Set and axis of rotation: CalculiX knows one for each element.
    spin: tuple[str, float] = ("EALL", 0.0)

    def size(self, kind: str) -> float:
        """A load of a kind that bends the strip about as much as the others do."""
        force = (0.02 if self.slender else 1.0) * self.random.choice(
            (0.3, 0.5, 0.7, 1.1, 1.3, -0.9)
        )
        scale = {
            "force": 1.0,
            "pressure": 5.0,
            "gravity": 100.0,
            "centrifugal": 40.0,
            "moved": 0.15,
            "heat": 60.0,
        }[kind]
        return abs(force * scale) if kind == "centrifugal" else force * scale

    def amplitude(self, share: float = 0.4) -> str:
        return self.random.choice(list(TABLES)) if self.random.random() < share else ""


def generate(number: int) -> Deck:
    """The deck of a number."""
    theme = THEMES[number % len(THEMES)]
    random = Random(f"deck {number}")
    slender = theme in ("large rotations", "buckling")
    writer = _Writer(random, slender)
    writer.spin = random.choice((("EALL", 0.0), ("HALF", 0.0), ("SAME", -1.0), ("ALSO", -1.0)))
    height = 0.05 if slender else 0.25
    element, poisson = random.choice((("CPE8R", 0.3), ("CPE8", 0.3), ("CPS8R", 0.0)))
    if theme in ("forces", "edges") and random.random() < 0.3:
        element, poisson = "CPE6", 0.2
    if theme == "temperatures":
        element, poisson = "CPE4", 0.3
    if theme in FULL:
        element, poisson = random.choice((("CPE8", 0.3), ("CPE8", 0.0), ("CPS8", 0.0)))
    heats = theme == "temperatures"
    head = _head(element, poisson, height, heats)
    steps, ends = _steps(writer, theme, heats)
    tolerance = 1e-3 if slender or theme in FULL else 2e-5
    return Deck(number, theme, head + steps, ends, writer.features, tolerance)


def _head(element: str, poisson: float, height: float, heats: bool) -> str:
    kind = {"CPE6": "tri6", "CPE4": "quad4"}.get(element, "quad8")
    mesh = ct.mesh.rectangle(LENGTH, height, CELLS, 1, kind)
    lines = ["*NODE, NSET=NALL"]
    lines += [
        f"{label}, {x:.12g}, {y:.12g}, 0."
        for label, (x, y) in zip(mesh.node_labels.tolist(), mesh.points.tolist(), strict=True)
    ]
    lines.append(f"*ELEMENT, TYPE={element}, ELSET=EALL")
    for cells in mesh.cells:
        for label, nodes in zip(cells.labels.tolist(), mesh.node_labels[cells.nodes], strict=True):
            lines.append(f"{label}, " + ", ".join(map(str, nodes.tolist())))
    for name, where in NODE_SETS.items():
        labels = mesh.node_labels[mesh.nodes_of(where)] if where != "all" else mesh.node_labels
        lines += [f"*NSET, NSET={name}", *(f"{n}," for n in labels.tolist())]
    for name, numbers in ELEMENT_SETS.items():
        lines += [f"*ELSET, ELSET={name}", *(f"{n}," for n in numbers)]
    for name, (elset, side) in SURFACES.items():
        lines += [f"*SURFACE, NAME={name}, TYPE=ELEMENT", f"{elset}, S{side}"]
    for name, (time, table) in TABLES.items():
        lines += [f"*AMPLITUDE, NAME={name}, TIME={time}", table]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"1e6, {poisson}", "*DENSITY", "1."]
    if heats:
        lines += ["*EXPANSION", "1e-5"]
    lines += ["*SOLID SECTION, ELSET=EALL, MATERIAL=M", ".1"]
    if heats:
        lines += ["*INITIAL CONDITIONS, TYPE=TEMPERATURE", "NALL, 20."]
    lines += ["*BOUNDARY", "LEFT, 1, 2"]
    return "\n".join(lines) + "\n"


def _steps(writer: _Writer, theme: str, heats: bool) -> tuple[str, list[float]]:
    random = writer.random
    text, ends, time = "", [], 0.0
    count = random.randint(2, 4)
    nlgeom = False
    procedures = _procedures(random, theme, count)
    for number, procedure in enumerate(procedures):
        options = ""
        if theme == "large rotations" and (number == 0 or random.random() < 0.3):
            options, nlgeom = ", NLGEOM", True
        if procedure in ("frequency", "buckle") and random.random() < 0.6 and number:
            options = ", PERTURBATION"
        ramp = procedure in ("dynamic", "modal dynamic", "static") and random.random() < 0.3
        grows = False
        if ramp:
            how = random.choice(("RAMP", "STEP"))
            options += f", AMPLITUDE={how}"
            grows = how == "RAMP" and procedure != "static"
        period = random.choice((1.0, 0.7))
        text += f"*STEP{options}, INC=1000\n"
        if procedure in ("frequency", "buckle"):
            storage = ", STORAGE=YES" if theme == "modal" else ""
            text += f"*{procedure.upper()}{storage}\n{6 if theme == 'modal' else 3}\n"
            if theme == "modal":
                # CalculiX wants forces on 2-D elements to be there when it finds the modes.
                text += "*CLOAD\n" + "".join(
                    f"{n}, {d}, 0.\n" for n in ("RIGHT", "TOP") for d in (1, 2)
                )
            if procedure == "buckle":
                text += f"*CLOAD\nRIGHT, 1, {-abs(writer.size('force'))}\n"
            text += "*END STEP\n"
            continue
        if procedure == "static":
            parts = 4 if nlgeom else 1
            direct = ", DIRECT" if nlgeom else ""
            text += f"*STATIC{direct}\n{period / parts:.12g}, {period}\n"
        else:
            period *= 0.5
            direct = ", DIRECT" if procedure == "dynamic" else ""
            text += f"*{procedure.upper()}{direct}\n{period / 10:.12g}, {period:.12g}\n"
        text += _cards(writer, theme, procedure, number, heats, grows)
        text += "*NODE PRINT, NSET=RIGHT\nU\n*NODE PRINT, NSET=LEFT, TOTALS=ONLY\nRF\n"
        text += f"*EL PRINT, ELSET=ONE\nS{', ENER' if theme == 'motion' else ''}\n*END STEP\n"
        time += period
        ends.append(time)
    return text, ends


def _procedures(random: Random, theme: str, count: int) -> list[str]:
    if theme == "motion":
        return [*(["static"] if random.random() < 0.5 else []), *["dynamic"] * random.randint(1, 2)]
    if theme == "frequencies":
        return [*["static"] * random.randint(0, 2), "frequency"]
    if theme == "buckling":
        return [*["static"] * random.randint(0, 1), "buckle"]
    if theme == "modal":
        return ["frequency", "modal dynamic"]
    return ["static"] * count


def _cards(
    writer: _Writer, theme: str, procedure: str, number: int, heats: bool, grows: bool
) -> str:
    """The load cards of a step."""
    random = writer.random
    groups = {
        "forces": ["force"],
        "edges": ["edge"],
        "bodies": ["body"],
        "supports": ["moved", "force"],
        "temperatures": ["heat", "force"],
        "frequencies": ["axial"],
        "buckling": ["axial"],
        "modal": ["force", "edge", "body"],
        "motion": ["force", "edge", "body"],
    }.get(theme, ["force", "edge", "body", "moved"])
    if heats and procedure == "static" and "heat" not in groups:
        groups = [*groups, "heat"]
    text = ""
    said: dict[tuple[object, ...], str] = {}
    opened: set[str] = set()
    pressed = False
    if any(a and a not in RUNS_ON for a in writer.heated.values()):
        writer.features.add("heat with step time")
    for _ in range(random.randint(1 if number == 0 else 0, 4)):
        group = random.choice(groups)
        if procedure == "modal dynamic" and group == "moved":
            continue
        card = _MAKERS[group](writer, random)
        kind = {"edge": "d", "body": "d", "axial": "force"}.get(group, group)
        new = number > 0 and kind not in opened and random.random() < 0.3
        amplitude = "" if group == "axial" else writer.amplitude()
        if any(said.get(k, amplitude) != amplitude for k in card.keys):
            continue
        said |= dict.fromkeys(card.keys, amplitude)
        options = (", OP=NEW" if new else "") + (f", AMPLITUDE={amplitude}" if amplitude else "")
        if group == "moved" and new:
            text += f"*BOUNDARY, OP=NEW\nLEFT, 1, 2\n*BOUNDARY{options.replace(', OP=NEW', '')}\n"
        else:
            text += f"*{card.name}{options}\n"
        text += card.row + "\n"
        opened.add(kind)
        _remember(writer, group, new, amplitude, card)
        if "CENTRIF" in card.row and theme == "large rotations":
            writer.features.add("rotation under NLGEOM")
        if procedure == "dynamic" and (new or amplitude or not grows):
            writer.features.add("sudden load in motion")
        if grows and group == "edge" and writer.pressed:
            writer.features.add("edge load inserted under a ramp")
        pressed = pressed or group == "edge"
    writer.pressed = writer.pressed or pressed
    if number and random.random() < 0.15 and "force" not in opened and "force" in groups:
        text += "*CLOAD, OP=NEW\n"
        if procedure == "dynamic":
            writer.features.add("sudden load in motion")
    return text


def _remember(writer: _Writer, group: str, new: bool, amplitude: str, card: _Card) -> None:
    """Note what the exceptions are known by."""
    if group == "heat":
        if new and any(a in RUNS_ON for a in writer.heated.values()):
            writer.features.add("heat taken away from total time")
        if new:
            writer.heated.clear()
        writer.heated[card.row.split(",")[0]] = amplitude


@dataclass
class _Card:
    name: str
    row: str
    keys: Sequence[tuple[object, ...]]


def _force(writer: _Writer, random: Random) -> _Card:
    where = random.choice(("RIGHT", "TOP", "RIGHT"))
    dof = random.choice((1, 2))
    size = writer.size("force") / (9 if where == "TOP" else 3)
    # The sets share the corner node.
    return _Card("CLOAD", f"{where}, {dof}, {size:.6g}", [("force", dof)])


def _axial(writer: _Writer, random: Random) -> _Card:
    size = abs(writer.size("force")) * random.choice((3.0, 5.0))
    return _Card("CLOAD", f"RIGHT, 1, {size:.6g}", [("force", 1)])


def _edge(writer: _Writer, random: Random) -> _Card:
    size = writer.size("pressure")
    if random.random() < 0.5:
        name = random.choice(list(SURFACES))
        side = SURFACES[name][1]
        return _Card("DSLOAD", f"{name}, P, {size:.6g}", [("edge", side)])
    where, side = random.choice(("EALL", "HALF", "SAME", "ONE", "3")), random.choice((1, 3))
    return _Card("DLOAD", f"{where}, P{side}, {size:.6g}", [("edge", side)])


def _body(writer: _Writer, random: Random) -> _Card:
    where = random.choice(("EALL", "HALF", "SAME", "ALSO"))
    if random.random() < 0.3:
        where, axis = writer.spin
        size = writer.size("centrifugal")
        row = f"{where}, CENTRIF, {size:.6g}, {axis}, 0., 0., 0., 0., 1."
        return _Card("DLOAD", row, [("spin", where, axis)])
    along = random.choice(("0., -1., 0.", "1., 0., 0.", "0., 1., 0.", "0., -2., 0."))
    size = random.choice((writer.size("gravity"), 0.0, writer.size("gravity")))
    return _Card("DLOAD", f"{where}, GRAV, {size:.6g}, {along}", [("gravity", where)])


def _moved(writer: _Writer, random: Random) -> _Card:
    size = writer.size("moved")
    return _Card("BOUNDARY", f"RIGHT, 2, 2, {size:.6g}", [("moved", 2)])


def _heat(writer: _Writer, random: Random) -> _Card:
    # All nodes: a brick of CalculiX has the mean temperature of its nodes.
    where = random.choice(("NALL", "EVERY"))
    return _Card("TEMPERATURE", f"{where}, {abs(writer.size('heat')) + 20.0:.6g}", [("heat",)])


_MAKERS = {
    "force": _force,
    "axial": _axial,
    "edge": _edge,
    "body": _body,
    "moved": _moved,
    "heat": _heat,
}

__all__ = ["COUNT", "THEMES", "Deck", "generate"]
