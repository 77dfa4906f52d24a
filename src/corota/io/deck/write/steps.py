"""Steps of a model as cards of a deck: a function for each procedure."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import UnsupportedError
from corota.io.deck.cards.dynamic import ANY_ERROR
from corota.io.deck.write.contact import step_cards as contact_step_cards
from corota.io.deck.write.contact import surfaces
from corota.io.deck.write.loads import boundary, ending, load_cards
from corota.io.deck.write.text import DOFS, Writer, number, numbers, plain
from corota.model.dofs import dof_index
from corota.model.loads import AppliedLoad, LoadKind, applied, applied_in_step, given_as, kind_of
from corota.model.paths import ArcLength, Label
from corota.model.steps import (
    Buckle,
    Dynamic,
    Frequency,
    ModalDynamic,
    Static,
    SteadyState,
    Step,
    Visco,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from corota.io.deck.write.compare import Written

#: Cards that remove the loads of a kind.
_NEW: dict[LoadKind, str] = {"force": "CLOAD", "distributed": "DLOAD", "temperature": "TEMPERATURE"}
#: Arcs of a path in a deck are fractions of one load.
_ARCS = 1.0
#: Number of the last mode where all are meant.
_EVERY_MODE = 1_000_000


def step_cards(writer: Writer, steps: Sequence[Written]) -> Iterator[str]:
    """Cards of all steps; what they stand for is entered in `steps`.

    Raises
    ------
    UnsupportedError
        If a procedure, or one of its options, has no card.
    """
    model = writer.model
    own = applied(model.loads, model.mesh)
    loaded, restart = False, 0
    acting: list[AppliedLoad] = []
    for index, written in enumerate(steps, start=1):
        step = written.step
        cards = PROCEDURES.get(type(step))
        if cards is None:
            raise UnsupportedError(
                f"step {index}: {type(step).__name__} cannot be written to a deck"
            )
        loads: list[AppliedLoad] = []
        supports = list(step.supports)
        if isinstance(step, Buckle):
            alone = not step.loads and not any(s.value for s in step.supports)
            if index == 1 or alone:
                loads += own
                if index > 1:
                    supports = [s for s in model.supports if s.value] + supports
        elif not isinstance(step, Frequency):
            # The model's loads act from the first loaded step on.
            kept = [x for x in own if given_as(x) not in step.ended]
            loads += [x for x in kept if not loaded or step.renews(kind_of(x))]
            loaded = loaded or not isinstance(step, SteadyState)
        loads += applied_in_step(step.loads, model.mesh)
        head, procedure = cards(_Says(writer, step, index))
        yield head
        if step.restart != restart:
            restart = step.restart
            yield f"*RESTART, WRITE, FREQUENCY={restart}\n"
        yield procedure
        yield from contact_step_cards(writer, index)
        if step.new_supports:
            supports = [*model.supports, *supports]
        written.supports += supports
        yield from boundary(writer, supports, step.new_supports)
        for kind, card in _NEW.items():
            if step.renews(kind) or kind in step.ended:
                yield f"*{card}, OP=NEW\n"
        loads = [one for load in loads for one in ending(writer.mesh, load, acting)]
        acting += loads
        written.loads += loads
        for load in loads:
            yield from load_cards(writer, load)
        if isinstance(step, SteadyState):
            yield from boundary(writer, step.imaginary_supports, False, ", LOAD CASE=2")
            for load in applied(step.imaginary_loads, model.mesh):
                yield from load_cards(writer, load, ", LOAD CASE=2")
        yield from _outputs(writer, step)
        yield "*END STEP\n"


class _Says:
    """A step, and its options without a card.

    Parameters
    ----------
    step : Step
    index : int
        From 1.
    """

    def __init__(self, writer: Writer, step: Any, index: int) -> None:
        self.writer, self.step, self.index = writer, step, index

    def refuse(self, *names: str, of: object = None, what: str = "") -> None:
        """Refuse options that differ from their defaults."""
        found = self.step if of is None else of
        defaults = {f.name: f.default for f in fields(found)}  # type: ignore[arg-type]
        for name in names:
            if getattr(found, name) != defaults[name]:
                self.no(f"{name} of {what or type(found).__name__}")

    def no(self, what: str) -> None:
        """Refuse."""
        raise UnsupportedError(
            f"step {self.index}: {what} cannot be written to a deck: leave it out, or keep the "
            "model in Python"
        )

    def head(self, ramp: str = "", *, perturbs: bool = False, increments: int = 0) -> str:
        """``*STEP`` with its parameters; `ramp` is ``RAMP``, ``STEP`` or empty."""
        step = self.step
        # A perturbation is about the state as it is; with NLGEOM later steps would have it too.
        options = ", PERTURBATION" if perturbs else ", NLGEOM" if step.nlgeom else ", NLGEOM=NO"
        options += f", INC={increments or step.max_increments}"
        options += f", AMPLITUDE={ramp}" if ramp else ""
        return f"*STEP{options}\n"

    def direct(self) -> str:
        return ", DIRECT" if self.step.fixed_increments else ""

    def times(self) -> str:
        """First increment, period, smallest and largest increment."""
        s = self.step
        values = (s.first_increment, s.period, s.smallest_increment, s.largest_increment)
        return numbers(values) + "\n"


def _static(says: _Says) -> tuple[str, str]:
    step: Static = says.step
    says.refuse("at_limit", "plastic_increment")
    if step.tolerance > 1e-9:
        raise UnsupportedError(
            f"step {says.index}: a tolerance of {step.tolerance:g} cannot be written to a deck, "
            "whose steps take 1e-9 or a tighter one"
        )
    ramp = "" if step.ramp else "STEP"
    name = "STATIC"
    if isinstance(step, Visco):
        ramp, name = "RAMP" if step.ramp else "", "VISCO"
        if step.creep_tolerance is not None:
            name += f", CETOL={number(step.creep_tolerance)}"
    plain_text = f"*{name}{says.direct()}\n{says.times()}"
    text = plain_text if step.path is None else _riks(says, step)
    most = getattr(step.path, "increments", 0) or step.max_increments
    most = min(most, step.max_increments)
    return says.head(ramp, increments=most) + _controls(step), text


def _riks(says: _Says, step: Static) -> str:
    """A path by arc length: first arc, scale, smallest, largest; load factor; node, dof, value."""
    path = step.path
    if not isinstance(path, ArcLength):
        says.no(f"path={type(path).__name__} (of paths, ArcLength can be)")
    assert isinstance(path, ArcLength)
    says.refuse("shape", "locate", "switch", "side", "branch", "stop_at_limit", of=path)
    if step.period != _ARCS:
        says.no(f"a path with the period {step.period:g} instead of 1")
    largest = 0.0 if math.isinf(step.largest_increment) else step.largest_increment
    values = [step.first_increment, 1.0, step.smallest_increment, largest, path.factor or 0.0]
    text = numbers(values)
    if path.displacement is not None:
        where, dof, value = path.displacement
        text += f", {_controlled(says, where)}, {DOFS[dof_index(dof)]}, {number(value)}"
    return f"*STATIC, RIKS{says.direct()}\n{text}\n"


def _controlled(says: _Says, where: Any) -> int:
    """Label of the one node whose displacement ends a path."""
    mesh = says.writer.mesh
    if isinstance(where, Label):
        return int(where)
    nodes = mesh.node_indices(where if isinstance(where, str) else np.atleast_1d(where))
    if len(nodes) != 1:
        says.no("the mean displacement of several nodes as the end of a path")
    return int(mesh.node_labels[nodes[0]])


def _controls(step: Static) -> str:
    """Tolerance and iterations; they hold until the next card, so every step has its own."""
    text = "*CONTROLS, RESET\n"
    if step.tolerance != 1e-9:
        text += f"*CONTROLS, PARAMETERS=FIELD\n{number(step.tolerance)},\n"
    if step.max_iterations != 16:
        text += f"*CONTROLS, PARAMETERS=TIME INCREMENTATION\n, , , , {step.max_iterations}\n"
    return text


def _dynamic(says: _Says) -> tuple[str, str]:
    step: Dynamic = says.step
    says.refuse("tolerance", "max_iterations", "redistribute")
    if step.error_tolerance < ANY_ERROR:
        says.refuse("error_tolerance")
    options, explicit, slow = "", step.scheme == "central_difference", False
    if explicit:
        options = ", EXPLICIT"
    elif step.scheme == "hht":
        options = f", ALPHA={number(step.alpha)}"
    elif step.scheme == "newmark":
        options = ", ALPHA=0."  # HHT with this parameter is Newmark's scheme
    elif step.scheme == "energy_momentum":
        options = ", SCHEME=ENERGY MOMENTUM"
    elif step.scheme == "generalized_alpha" and step.rho_inf == 0.0:
        options, slow = ", APPLICATION=QUASI-STATIC", True
    else:
        more = f" with rho_inf={step.rho_inf:g}" if step.scheme == "generalized_alpha" else ""
        says.no(f"scheme={step.scheme!r}{more}")
    # An explicit step is always lumped.
    if step.mass != "consistent" and not explicit:
        says.no(f"mass={step.mass!r} of an implicit step")
    options += ", NOHAF" if step.error_tolerance >= ANY_ERROR else ""
    ramp = "RAMP" if step.ramp else "STEP" if slow else ""
    return says.head(ramp), f"*DYNAMIC{options}{says.direct()}\n{says.times()}"


def _buckle(says: _Says) -> tuple[str, str]:
    step: Buckle = says.step
    return says.head(perturbs=step.preload), f"*BUCKLE\n{step.modes}\n"


def _frequency(says: _Says) -> tuple[str, str]:
    step: Frequency = says.step
    if step.mass != "consistent":
        says.no(f"mass={step.mass!r} of Frequency")
    card = "COMPLEX FREQUENCY, CORIOLIS" if step.complex_modes else "FREQUENCY"
    row = f"{step.modes or ''}"
    if (step.lowest, step.highest) != (0.0, math.inf):
        high = "" if step.highest == math.inf else numbers((step.highest,))
        row += f", {numbers((step.lowest,))}, {high}"
    return says.head(perturbs=step.nlgeom), f"*{card}\n{row}\n"


def _modal_dynamic(says: _Says) -> tuple[str, str]:
    step: ModalDynamic = says.step
    says.refuse("residual")
    text = f"*MODAL DYNAMIC\n{says.times()}" + _modal_damping(step)
    return says.head("RAMP" if step.ramp else ""), text


def _steady_state(says: _Says) -> tuple[str, str]:
    step: SteadyState = says.step
    says.refuse("residual", "mass")
    row = f"{numbers((step.lowest, step.highest))}, {step.points}, {step.bias:.12g}\n"
    text = f"*STEADY STATE DYNAMICS{', DIRECT' if step.direct else ''}\n{row}"
    return says.head(), text + _modal_damping(step)


def _modal_damping(step: ModalDynamic | SteadyState) -> str:
    text = ""
    if isinstance(step.damping, int | float):
        if step.damping:
            text = f"*MODAL DAMPING\n1, {_EVERY_MODE}, {number(step.damping)}\n"
    elif step.damping:
        ranges = "".join(f"{a}, {b}, {number(share)}\n" for a, b, share in step.damping)
        text = f"*MODAL DAMPING\n{ranges}"
    return f"{text}*MODAL DAMPING, RAYLEIGH\n, , {numbers(step.rayleigh)}\n"


def _outputs(writer: Writer, step: Step) -> Iterator[str]:
    for request in step.outputs:
        yield f"*{request.kind.upper()}"
        if request.kind == "contact print" and request.where:
            pairs = {p.name: p for p in writer.model.contacts}
            slave, master = surfaces(writer, pairs[request.where])
            yield f", SLAVE={slave}, MASTER={master}"
        elif request.kind == "section print":
            yield f", SURFACE={writer.edge_set(request.where)}, NAME={plain(request.where)}"
        elif request.where:
            yield f", {'N' if 'node' in request.kind else 'EL'}SET={plain(request.where)}"
        if request.in_global:
            yield ", GLOBAL=YES"
        if request.frequency != 1:
            yield f", FREQUENCY={request.frequency}"
        if request.totals != "no":
            yield f", TOTALS={request.totals.upper()}"
        if request.time_points:
            yield f", TIME POINTS={plain(request.time_points)}"
        yield "\n" + ", ".join(request.variables) + "\n"


#: Writers of the cards of a procedure: ``*STEP``, and the procedure itself.
PROCEDURES: dict[type[Step], Callable[[_Says], tuple[str, str]]] = {
    Static: _static,
    Visco: _static,
    Dynamic: _dynamic,
    Buckle: _buckle,
    Frequency: _frequency,
    ModalDynamic: _modal_dynamic,
    SteadyState: _steady_state,
}
