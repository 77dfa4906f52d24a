"""Damping, point masses, dashpots, gaps and initial velocities of a model as cards of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import UnsupportedError
from corota.io.deck.write.text import DOFS, Writer, number, numbers
from corota.model.contact import is_gap, of_gap
from corota.model.steps import Dynamic, Frequency, Step

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from corota.model.attachments import Dashpot
    from corota.model.loads import InitialVelocity


def damping_card(rayleigh: tuple[float, float]) -> str:
    """``*DAMPING`` of a material, or before the first material that of the model."""
    if not any(rayleigh):
        return ""
    return f"*DAMPING, ALPHA={number(rayleigh[0])}, BETA={number(rayleigh[1])}\n"


def model_damping(writer: Writer, steps: Sequence[Step]) -> str:
    """Rayleigh damping of the steps that take it from the model.

    Raises
    ------
    UnsupportedError
        If steps differ in it, or the damping of materials would change.
    """
    taking = [s for s in steps if isinstance(s, Dynamic) or _complex(s)]
    pairs = {tuple(map(float, s.rayleigh)) for s in taking}  # type: ignore[attr-defined]
    if len(pairs) > 1:
        raise UnsupportedError(
            f"steps with different rayleigh damping {sorted(pairs)} cannot be written to a deck, "
            "whose *DAMPING is that of the whole analysis: give the damping to the materials "
            "(rayleigh=), or keep the model in Python"
        )
    model = writer.model
    own = {m.material.rayleigh for m in model.sections if any(m.material.rayleigh)}
    if own and model.point_masses:
        raise UnsupportedError(
            "damping of materials (rayleigh=) beside point masses cannot be written to a deck, "
            "where it would damp the masses too: give it to the step, or keep the model in Python"
        )
    return damping_card(pairs.pop()) if pairs else ""  # type: ignore[arg-type]


def _complex(step: Step) -> bool:
    return isinstance(step, Frequency) and step.complex_modes


def attachment_cards(writer: Writer) -> Iterator[str]:
    """Point masses, dashpots and gaps: separate elements with a card for the value."""
    mesh, model = writer.mesh, writer.model
    label = int(mesh.cell_labels.max(initial=0))
    for count, mass in enumerate(model.point_masses, start=1):
        kinds = [("MASS", "MASS", number(mass.mass))] if mass.mass or not mass.inertia else []
        if mass.inertia:
            kinds.append(("ROTARYI", "ROTARY INERTIA", f"0., 0., {number(mass.inertia)}"))
        for type_, card, value in kinds:
            yield f"*ELEMENT, TYPE={type_}, ELSET={type_}{count}\n"
            for node in mesh.node_labels[mesh.node_indices(mass.nodes)].tolist():
                label += 1
                yield f"{label}, {node}\n"
            yield f"*{card}, ELSET={type_}{count}\n{value}\n"
    count = 0
    for dashpot in model.dashpots:
        for along, c in dampers(dashpot):
            count, label = count + 1, label + 1
            both = [dashpot.first] if dashpot.second is None else [dashpot.first, dashpot.second]
            type_ = "DASHPOTA" if not along else f"DASHPOT{len(both)}"
            ends = ", ".join(map(str, mesh.node_labels[both].tolist()))
            yield f"*ELEMENT, TYPE={type_}, ELSET=DASHPOT{count}\n{label}, {ends}\n"
            option = ", NONLINEAR" if dashpot.table else ""
            rows = [numbers([f, v]) for v, f in dashpot.table] or [number(c)]
            places = ", ".join(str(DOFS[d]) for d in along[: len(both)])
            yield f"*DASHPOT, ELSET=DASHPOT{count}{option}\n{places}\n" + "\n".join(rows) + "\n"
    gaps = [p for p in model.contacts if is_gap(p)]
    for count, pair in enumerate(gaps, start=1):
        label += 1
        nodes, clearance, direction = of_gap(mesh.points, pair)
        first, second = mesh.node_labels[list(nodes)].tolist()
        yield f"*ELEMENT, TYPE=GAPUNI, ELSET=GAP{count}\n{label}, {first}, {second}\n"
        yield f"*GAP, ELSET=GAP{count}\n{numbers([clearance, *direction])}\n"


def dampers(dashpot: Dashpot) -> list[tuple[tuple[int, ...], float]]:
    """Elements of a dashpot: dofs at its ends, none along the line, and damping of each."""
    if dashpot.second is None and dashpot.dofs is None:
        return [((dof,), c) for dof, c in enumerate(dashpot.to_ground) if c]
    return [(dashpot.dofs or (), dashpot.c)]


def velocity_cards(writer: Writer, steps: Sequence[Step]) -> Iterator[str]:
    """Initial velocities by node and dof; a spin as that of the undeformed body.

    Raises
    ------
    UnsupportedError
        If a body that is deformed before the first dynamic step spins.
    """
    spun = False
    for item in writer.model.velocities:
        yield "*INITIAL CONDITIONS, TYPE=VELOCITY\n"
        if item.dof is not None or len(item.value) == 2 or item.value[2] == 0.0:
            pairs = [(0 if item.dof is None else item.dof, item.value[0])]
            if item.dof is None:
                # An earlier spin of these nodes is replaced.
                pairs += [(1, item.value[1])] + ([(2, 0.0)] if spun else [])
            for target in writer.nodes(item.nodes if len(item.nodes) else _every(writer)):
                for dof, value in pairs:
                    yield f"{target}, {DOFS[dof]}, {number(value)}\n"
            continue
        spun = True
        before = steps[: next((i for i, s in enumerate(steps) if isinstance(s, Dynamic)), 0)]
        if any(s.procedure == "static" and s.nlgeom for s in before):
            raise UnsupportedError(
                "an initial spin after a static step with large displacements, which is that of "
                "the displaced body, cannot be written to a deck: keep the model in Python"
            )
        yield from _spin(writer, item)


def _every(writer: Writer) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    return np.arange(writer.mesh.n_nodes)


def _spin(writer: Writer, item: InitialVelocity) -> Iterator[str]:
    mesh = writer.mesh
    nodes = mesh.node_indices(item.nodes) if len(item.nodes) else _every(writer)
    vx, vy, spin, x0, y0 = (*item.value, 0.0, 0.0)[:5]
    for label, (x, y) in zip(
        mesh.node_labels[nodes].tolist(), mesh.points[nodes].tolist(), strict=True
    ):
        motion = (vx - spin * (y - y0), vy + spin * (x - x0), spin)
        for dof, value in zip(DOFS, motion, strict=True):
            yield f"{label}, {dof}, {numbers([value])}\n"
