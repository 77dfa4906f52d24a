"""The scalars of frames: what each history of the whole model is, and its dimension."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
import re

from corota.results.measures import MEASURES, stage_measure

#: Scalars of frames that are undefined where missing; others are 0 there.
UNKNOWN = ("stable", "negative pivots")
#: Attributes of frames that are scalars, too, by their names.
OF_FRAMES = {
    "step": "step",
    "increment": "increment",
    "time": "time",
    "step time": "step_time",
    "load factor": "factor",
}
#: Start of the entries of stages.
STAGE = "STAGE: "

#: Name to meaning and dimension, empty for a number without one. ``k`` is the number of a mode,
#: ``PAIR`` the name of a contact pair, ``STAGE`` that of a stage (docs/measures.md). The energies
#: are explained in docs/energy.md.
SCALARS: dict[str, tuple[str, str]] = {
    "time": ("total time", "time"),
    "step time": ("time in the step", "time"),
    "load factor": ("share of the loads of the step", ""),
    "step": ("number of the step", ""),
    "increment": ("number of the increment", ""),
    "dt": ("size of the increment", "time"),
    "iterations": ("Newton iterations of the increment", ""),
    "attempts": ("attempts at the increment, cut-backs included", ""),
    "residual": ("largest residual over the scale of forces", ""),
    "negative pivots": ("negative eigenvalues of the tangent", ""),
    "stable": ("1 where the equilibrium is stable, else 0; not determined with friction", ""),
    "arc length": ("1 in increments that arc length took over from load control", ""),
    "limit point": ("1 at a limit point of a path", ""),
    "bifurcation point": ("1 at a bifurcation point of a path", ""),
    **dict.fromkeys(
        ("ALLSE", "ALLPD", "ALLCD", "ALLDMD", "ALLAE", "ALLIE", "ALLKE", "ALLVD", "ALLFD"),
        ("part of the energy balance", "energy"),
    ),
    **dict.fromkeys(("ALLSD", "ALLCL"), ("part of the energy balance", "energy")),
    **dict.fromkeys(
        ("ALLPW", "ALLWK", "ALLTH", "ETOTAL"), ("part of the energy balance", "energy")
    ),
    "energy balance": ("change of ETOTAL since the start", "energy"),
    "energy balance error": ("that change over the largest energy so far", ""),
    "strain energy": ("ALLSE + ALLAE", "energy"),
    "external work": ("ALLWK", "energy"),
    "internal work": ("work of the internal forces", "energy"),
    "kinetic energy": ("ALLKE", "energy"),
    "damping energy": ("ALLVD", "energy"),
    "friction energy": ("ALLFD", "energy"),
    "contact energy": ("ALLCL", "energy"),
    "stabilization energy": ("ALLSD", "energy"),
    "wetted length": ("undeformed length of the edges that fluids have reached", "length"),
    "modal strain energy": ("strain energy of the modes that are superposed", "energy"),
    "between increments": ("1 at a requested time within an explicit increment", ""),
    **{
        f"{which} {name}{i}": ("of all nodes and increments since the frame before", of)
        for name, of in (("U", "length"), ("V", "length/time"))
        for i in (1, 2)
        for which in ("smallest", "largest")
    },
    **{
        f"{which} total {name}{i}": (
            "of the sums in the increments since the frame before",
            "force",
        )
        for name in ("F", "RF")
        for i in (1, 2)
        for which in ("smallest", "largest")
    },
    "momentum x": ("linear momentum along x", "force*time"),
    "momentum y": ("linear momentum along y", "force*time"),
    "angular momentum": ("about the origin, at current positions", "force*length*time"),
    "PAIR: force x": ("contact force on the slave surface", "force"),
    "PAIR: force y": ("contact force on the slave surface", "force"),
    "PAIR: moment": ("its moment about the origin", "force*length"),
    "PAIR: area": ("closed area", "length^2"),
    "PAIR: gap": ("smallest gap of its nodes", "length"),
    "PAIR: friction x": ("friction's part of the force", "force"),
    "PAIR: friction y": ("friction's part of the force", "force"),
    "PAIR: friction moment": ("friction's part of the moment", "force*length"),
    "frequency k": ("natural frequency", "1/time"),
    "growth rate k": ("rate of growth of a complex mode", "1/time"),
    "damping ratio k": ("share of critical damping of a complex mode", ""),
    "effective mass x k": ("share of the mass that moves with a mode", ""),
    "effective mass y k": ("share of the mass that moves with a mode", ""),
    "participation x k": ("participation factor, as CalculiX prints it", ""),
    "participation y k": ("participation factor, as CalculiX prints it", ""),
    "participation rotation k": ("participation factor about the origin", ""),
    "moving mass x": ("mass of the free dofs", "mass"),
    "moving mass y": ("mass of the free dofs", "mass"),
    "moving mass rotation": ("inertia of the free dofs about the origin", "mass*length^2"),
    "buckling factor k": ("factor on the perturbing load", ""),
    "frequency": ("of the harmonic response", "1/time"),
    "largest amplitude": ("largest displacement of the harmonic response", "length"),
    "phase at largest": ("its phase [rad]", ""),
    **{STAGE + name: (m.meaning, m.dimension) for name, m in MEASURES.items()},
}


def general(name: str) -> str:
    """Entry of :data:`SCALARS` of a scalar: pairs and numbers of modes by their letters.

    Examples
    --------
    >>> general("floor: force x"), general("effective mass x 3"), general("ALLSE")
    ('PAIR: force x', 'effective mass x k', 'ALLSE')
    """
    if name in SCALARS:
        return name
    if ": " in name:
        of_pair = re.fullmatch(r".*(: (?:friction )?(?:force [xy]|[xy]|moment|area|gap))", name)
        if of_pair:
            return f"PAIR{of_pair.group(1)}"
    if measure := stage_measure(name):
        return STAGE + measure
    return re.sub(r" \d+$", " k", name) if name[-1:].isdigit() else name


def where_missing(name: str) -> float:
    """Value of a scalar in a frame without it: NaN where it is undefined there, else 0.

    Examples
    --------
    >>> where_missing("hub: instant center x"), where_missing("friction energy")
    (nan, 0.0)
    """
    # Contact pairs and stages have forces of the same names; a pair that is not there carries none.
    of_stage = stage_measure(name) and not general(name).startswith("PAIR")
    return math.nan if name in UNKNOWN or of_stage else 0.0


def table() -> list[str]:
    """The table of the documents: name, meaning, dimension; without those of stages."""
    rows = ["| history | meaning | dimension |", "| --- | --- | --- |"]
    for name, (meaning, dimension) in SCALARS.items():
        if name.startswith(STAGE):
            continue
        shown = meaning.replace("energy balance", "[energy balance](energy.md)")
        rows.append(f"| `{name}` | {shown} | {dimension} |")
    return rows
