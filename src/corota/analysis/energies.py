"""The energy balance of an analysis: one for all procedures, over all steps.

Every increment adds the work of loads, of moving supports and of viscous forces by the
trapezoidal rule (the energy-momentum scheme: by its mid-point forces). Terms of the equation
contribute their stored and dissipated energy. Stored energy is a function of the state;
dissipation comes from the return map and from slip. The total must be constant: its change is
an error of the integration in time.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from corota.model.schemes import SCHEMES

if TYPE_CHECKING:
    from corota.analysis.equations import System
    from corota.analysis.evaluation import Evaluation
    from corota.analysis.procedures.motion import ConservingMotion, NewmarkMotion
    from corota.analysis.terms.inertia import Inertia, MotionState
    from corota.arrays import Floats
    from corota.model.steps import Dynamic, Step


#: Energies by Abaqus's names, with descriptions; ALLTH and ALLCL are ours.
ENERGIES = {
    "ALLSE": "recoverable strain energy",
    "ALLPD": "plastic work",
    "ALLCD": "work of creep and of viscoelasticity that is not recoverable",
    "ALLDMD": "energy lost by the softening of rubber",
    "ALLAE": "energy of the drilling penalty",
    "ALLIE": "internal energy: ALLSE + ALLPD + ALLCD + ALLDMD + ALLAE",
    "ALLKE": "kinetic energy",
    "ALLVD": "viscous dissipation: dashpots, Rayleigh damping",
    "ALLFD": "frictional dissipation",
    "ALLSD": "dissipation of contact stabilization",
    "ALLCL": "energy stored by contact pressure laws",
    "ALLPW": "work of pressures on gaps that change within static increments, and of all contact "
    "forces in central differences; less ALLFD and ALLCL",
    "ALLWK": "work of loads and of moving supports; kinetic energy set at the start of a step",
    "ALLTH": "work of thermal expansion and of moduli that follow the temperature",
    "ETOTAL": "ALLKE + ALLIE + ALLVD + ALLFD + ALLSD + ALLCL - ALLPW - ALLWK - ALLTH",
}
#: Names of the energy-conserving scheme in Python and decks.
CONSERVES = "scheme='energy_momentum' (*DYNAMIC, SCHEME=ENERGY MOMENTUM)"
#: Share of the largest energy from which a balance error is worth a warning.
LARGE_ERROR = 0.02
#: Relative rounding error of an energy.
NEGLIGIBLE_ENERGY = 1e-12


class Energies:
    """The energy balance of one analysis.

    Attributes
    ----------
    work, viscous, contact : float
        Of external and viscous forces, and of contact forces, so far [force*length].
    kinetic : float
        Kinetic energy of the committed state [force*length].
    error : float
        Largest balance error so far over the largest energy so far, signed.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self.work = self.viscous = self.contact = self.internal = self.kinetic = 0.0
        #: Of contact in central differences, less friction and stored energy; None without.
        self.impact: float | None = None
        self.error, self.where = 0.0, (1, 0)
        self.scheme = "static"
        self._reference: float | None = None
        self._largest = self._worst = 0.0
        # Forces that do work, at the committed state: loads, and reactions of prescribed dofs.
        self._driving: Floats | None = None

    # -- steps and increments ----------------------------------------------------------

    def begin(self, step: Step, internal: Floats) -> None:
        """Start a step; in a static one nothing moves.

        Forces not in equilibrium then, such as initial stress or a stopped motion, are released
        in the first increment, as if an external force had balanced them.
        """
        if self._driving is None or (step.procedure == "static" and self.scheme != "static"):
            self._driving = internal - self.system.multiplier_force()
        self.scheme = getattr(step, "scheme", "static")
        if step.procedure == "static":
            self.set_kinetic(0.0)

    def set_kinetic(self, kinetic: float) -> None:
        """Set the kinetic energy at the start of a step, in place of the last one's.

        What another mass, another velocity or a stop changes is work from outside.
        """
        if self._reference is not None:
            self.work += kinetic - self.kinetic
        self.kinetic = kinetic

    def drive(self, external: Floats, reaction: Floats) -> None:
        """Forces at the start of a dynamic step; statics continues from those before."""
        self._driving = self._sum(external, reaction)

    def _sum(self, external: Floats, reaction: Floats) -> Floats:
        return external + np.where(self.system.conditions.constrained, reaction, 0.0)

    def add_quasi_static(self, u: Floats, before: Floats, at: Evaluation) -> None:
        """Work of a static increment that ends at `u`."""
        self.add_work(u - before, at.external, self.system.reaction(at))

    def add_work(self, d: Floats, external: Floats, reaction: Floats, middle: bool = False) -> None:
        """Work on an increment `d`, of forces at its end or at its middle."""
        driving = self._sum(external, reaction)
        mean = driving
        if not middle and self._driving is not None:
            mean = 0.5 * (self._driving + driving)
        self.work += float(np.einsum("i,i->", mean, d))
        self._driving = driving

    # -- output ------------------------------------------------------------------------

    def add_to(
        self, scalars: dict[str, float], sums: dict[str, float] | None, where: tuple[int, int]
    ) -> None:
        """Write the energy balance into a frame's scalars.

        `sums` are those of the elements; without them the work of their forces counts.
        """
        terms: dict[str, float] = {}
        for term in self.system.terms:
            for name, energy in term.energies().items():
                terms[name] = terms.get(name, 0.0) + energy
        stored, pressed = terms.pop("ALLSE", 0.0), terms.pop("ALLPW", 0.0)
        work = self.work + terms.pop("ALLWK", 0.0)
        inside = (
            {"ALLIE": self.internal, "ALLTH": 0.0}
            if sums is None
            else {
                "ALLSE": sums["strain energy"] - sums["artificial energy"] + stored,
                "ALLPD": sums["plastic work"],
                **({"ALLCD": sums["creep work"]} if self.system.depends_on_time else {}),
                **({"ALLDMD": sums["damage"]} if sums["damage"] else {}),
                "ALLAE": sums["artificial energy"],
                "ALLIE": stored
                + sum(
                    sums[name] for name in ("strain energy", "plastic work", "creep work", "damage")
                ),
                "ALLTH": sums["thermal work"],
            }
        )
        own = {
            **inside,
            "ALLKE": self.kinetic,
            "ALLVD": self.viscous,
            **terms,
            "ALLWK": work,
        }
        gained = ("ALLIE", "ALLKE", "ALLVD", "ALLFD", "ALLSD", "ALLCL")
        own["ETOTAL"] = sum(own[k] for k in gained) - own["ALLWK"] - own["ALLTH"]
        if self.impact is not None or pressed:
            own["ALLPW"] = pressed + (self.impact or 0.0)
            own["ETOTAL"] -= own["ALLPW"]
        if self._reference is None:
            self._reference = own["ETOTAL"]
        missing = own["ETOTAL"] - self._reference
        self._largest = max(self._largest, *(abs(v) for k, v in own.items() if k != "ETOTAL"))
        known = self._largest > self._negligible()
        if abs(missing) > abs(self._worst):
            self._worst, self.where = missing, where
        self.error = self._worst / self._largest if known else 0.0
        scalars.update({name: own[name] for name in ENERGIES if name in own})
        scalars["energy balance"] = missing
        scalars["energy balance error"] = missing / self._largest if known else 0.0

    def _negligible(self) -> float:
        """Energy of rounding size: of forces, or of strains canceled by free expansion."""
        free, scales, length = self.system.free, self.system.scales, self.system.length
        expansion = free.largest(free.start - free.now) * length if free.responds else 0.0
        rounding = scales.zero_force * max(scales.moved, NEGLIGIBLE_ENERGY * length)
        return max(rounding, NEGLIGIBLE_ENERGY * scales.stiffest * expansion**2)

    @property
    def largest(self) -> float:
        """Largest energy so far [force*length]."""
        return self._largest

    @property
    def made_by_contact(self) -> bool:
        """Whether impacts have created more energy than rounding and increments explain."""
        implicit = self.scheme in SCHEMES
        return implicit and self.system.opens and self.error > LARGE_ERROR

    def remark(self) -> str:
        """Message on the largest error; empty where it is small."""
        if abs(self.error) <= LARGE_ERROR:
            return ""
        verb = "gained" if self.error > 0.0 else "lost"
        text = (
            f"energy balance: {abs(self.error):.1%} of the largest energy is {verb} by step "
            f"{self.where[0]}, increment {self.where[1]} (ETOTAL): "
        )
        if own := [repr(term.name) for term in self.system.terms[2:-1]]:
            text += f"a force of {', '.join(own)} that is in no energy (Term.energies), or "
        impacts = self.system.opens
        if self.scheme == "energy_momentum" or (self.scheme == "newmark" and not impacts):
            return text + "use smaller increments"
        if self.scheme in SCHEMES:
            if impacts and self.error > 0.0:
                return text + (
                    f"{self.scheme} does not conserve energy where contact opens and closes; use "
                    f"{CONSERVES}, which does, or smaller increments"
                )
            cause = "" if self.scheme == "newmark" else f"numerical dissipation of {self.scheme}"
            if impacts:
                cause += f"{' and ' * bool(cause)}contact that opens and closes within increments"
            if self.error < 0.0:
                return text + (f"{cause}; use smaller increments, or {CONSERVES}, which has none")
            return text + f"use smaller increments, or {CONSERVES}"
        return text + "the work of the loads is summed over the increments: use smaller ones"


class Balance:
    """Contributions of a dynamic step to the energy balance, per increment.

    Parameters
    ----------
    now : MotionState
        Where it starts.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset({"inertia"})

    def __init__(
        self, system: System, step: Dynamic, now: MotionState, inertia: Inertia, account: Energies
    ) -> None:
        self.system, self.step, self.now, self.inertia = system, step, now, inertia
        self.account = account
        self.carried = step.scheme == "energy_momentum"
        first = self._kinetic(now)
        account.set_kinetic(first[0])
        self.energy, self.mass, self.momenta = first[0], first[4], first[1:4]
        self._inside = self._outside = 0.0
        self._contact = system.multiplier_force()
        account.drive(now.external, now.reaction() - self._contact)

    def _kinetic(self, now: MotionState) -> list[float]:
        momenta: list[float] = self.inertia.momenta(now.u, now.v, self.carried).tolist()
        return momenta

    @property
    def external(self) -> float:
        """Work of external forces so far."""
        return self.account.work

    def driven(self, now: MotionState) -> float:
        """Energy of the body in the frame of the driver: that of an impact from rest."""
        moved = self.system.conditions.constrained & ~self.system.is_rotation
        velocity = self.system.by_node(np.where(moved, now.v, 0.0))[:, :2]
        return 0.5 * self.mass * float((velocity * velocity).sum(axis=1).max())

    def accept(self, motion: NewmarkMotion | ConservingMotion, contact: Floats) -> None:
        """Add the work of an increment, in which contact has a force, shape (n_dofs,)."""
        begin, end, account = motion.start, motion.end, self.account
        middle = hasattr(motion, "increment")
        if middle:
            d = motion.increment(end.u)  # type: ignore[union-attr]
            internal, damping = end.internal, end.damping
        else:
            d = end.u - begin.u
            internal = 0.5 * (begin.internal + end.internal)
            damping = 0.5 * (begin.damping + end.damping)
        before = account.work
        account.add_work(d, end.external, end.reaction() - contact, middle)
        inside = float(internal @ d)
        account.internal += inside
        account.viscous += float(damping @ d)
        account.contact += float(contact @ d)
        self._contact, self.now = contact, end
        momenta = self._kinetic(end)
        account.kinetic = momenta[0]
        self.momenta = momenta[1:4]
        self._inside += inside
        self._outside += account.work - before
        self.energy = max(self.energy, abs(self._inside), abs(self._outside))

    def add_to(self, scalars: dict[str, float]) -> None:
        """Write momenta and the scheme's own sums into a frame's scalars."""
        account = self.account
        if self.system.n_multipliers:
            scalars["contact work"] = account.contact
        px, py, angular = self.momenta
        scalars.update(
            {
                "kinetic energy": account.kinetic,
                "internal work": account.internal,
                "external work": account.work,
                "damping energy": account.viscous,
                "momentum x": px,
                "momentum y": py,
                "angular momentum": angular,
            }
        )
