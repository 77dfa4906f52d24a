"""Random decks from the table of keywords: most cards make sense, some do not."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import random

from mutate import CARDS, NUMBERS, WORDS
from seeds import BUCKLING, CONSTRAINED, DECK, FULL, HEAD, MOVING, RIGID, SUPPORT

from corota.io.deck.keywords import KEYWORDS

NAMES = ["nall", "eall", "TIP", "END", "steel", "1", "2", "a", "s", "up"]
VALUES = ["1", "2", "3", "4", "5", "6", "20", ".5", "1.", "-2.", "1e-3", "0", "210000.", ".3"]
PARAMETERS = {
    "TYPE": [
        "CPS4",
        "CPS3",
        "CPE8R",
        "Q4D",
        "OPT",
        "ELEMENT",
        "NODE",
        "R",
        "ISOTROPIC",
        "C",
        "VELOCITY",
        "ENGINEERING CONSTANTS",
        "LAMINA",
    ],
    "HARDENING": ["ISOTROPIC", "KINEMATIC", "COMBINED"],
    "OP": ["NEW", "MOD"],
    "PLANE": ["STRESS", "STRAIN"],
    "LOCALSTRAIN": ["SIMPLIFIED", "MODIFIED", "LINEAR", "LOGARITHMIC", "GREEN LAGRANGE"],
}
PROCEDURES = (
    "STATIC",
    "STATIC",
    "BUCKLE",
    "DYNAMIC",
    "FREQUENCY",
    "MODALDYNAMIC",
    "STEADYSTATEDYNAMICS",
)
IN_STEPS = (
    "BOUNDARY",
    "CLOAD",
    "CLOAD",
    "DLOAD",
    "DSLOAD",
    "CONTROLS",
    "MODALDAMPING",
    "NODEPRINT",
    "ELPRINT",
    "NODEFILE",
    "ELFILE",
    "OUTPUT",
)
#: Share of parameters and fields that are of no sense.
ODD = 0.06


def _cards() -> dict[str, list[str]]:
    """Cards of the seeds with their data lines, by keyword."""
    found: dict[str, list[str]] = {}
    for seed in (DECK, FULL, CONSTRAINED, RIGID, MOVING, BUCKLING):
        for card in seed.split("\n*")[1:]:
            name = card.split("\n")[0].split(",")[0].replace(" ", "").upper()
            text = "*" + card.rstrip("\n")
            if text not in found.setdefault(name, []):
                found[name].append(text)
    return found


POOL = _cards()
#: What the cards of the seeds speak of.
NAMED = """*NSET, NSET=ends
1, 3
*NSET, NSET=more
1, 3, 6
*ELSET, ELSET=second
2
*SURFACE, NAME=top
eall, S3
*AMPLITUDE, NAME=up
0., 0., .5, 2., 1., 1.
*TIME POINTS, NAME=tp
.5, 1."""


def deck(rng: random.Random, odd: float = 0.3) -> bytes:
    """A mesh with a section, random cards of the model, supports and a few random steps.

    `odd` is the share of cards that differ from one that stands in a sound deck.
    """
    lines = [HEAD.rstrip("\n"), NAMED]
    names = [k for k in KEYWORDS if k not in ("STEP", "ENDSTEP")]
    model = [k for k in names if k not in (*PROCEDURES, *IN_STEPS)]
    lines += [_card(rng.choice(model), rng, odd) for _ in range(rng.choice((0, 0, 1, 2, 3)))]
    lines.append(SUPPORT.rstrip("\n"))
    for _ in range(rng.randint(0, 3)):
        lines.append(rng.choice(["*STEP", "*STEP, NLGEOM", "*STEP, NLGEOM, INC=20"]))
        lines.append(_card(rng.choice(PROCEDURES), rng, odd))
        lines += [_card(rng.choice(IN_STEPS), rng, odd) for _ in range(rng.randint(0, 4))]
        if rng.random() < 0.9:
            lines.append("*END STEP")
    return ("\n".join(lines) + "\n").encode("utf-8", "surrogatepass")


def _card(name: str, rng: random.Random, odd: float) -> str:
    sound = rng.choice(POOL[name]) if name in POOL else ""
    if sound and rng.random() > odd:
        return sound
    chance = rng.random()
    if chance < 0.15:
        return rng.choice(CARDS)
    if sound and chance < 0.6:
        lines = sound.split("\n")
        at = rng.randrange(len(lines))
        fields = lines[at].split(",")
        fields[rng.randrange(len(fields))] = " " + _field(rng)
        lines[at] = ",".join(fields)
        return "\n".join(lines)
    head = f"*{name}"
    known = KEYWORDS[name]
    names = [*known.parameters.split(), *known.ignored.split()]
    for parameter in rng.sample(names, min(len(names), rng.choice((0, 1, 1, 2, 3)))):
        head += f", {parameter}"
        if rng.random() < 0.8:
            head += "=" + rng.choice(PARAMETERS.get(parameter, NAMES))
    rows = [head]
    for _ in range(rng.choice((0, 1, 1, 1, 2, 3))):
        fields = [_field(rng) for _ in range(rng.choice((1, 2, 3, 3, 4, 5, 8, 9)))]
        rows.append(", ".join(fields))
    return "\n".join(rows)


def _field(rng: random.Random) -> str:
    if rng.random() < ODD:
        return rng.choice(NUMBERS + WORDS)
    return rng.choice(VALUES if rng.random() < 0.7 else NAMES)
