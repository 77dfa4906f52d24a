"""Checks of a material law at a point: tangent, symmetry, objectivity, energy."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.display import Brief
from corota.errors import InputError
from corota.model.user_material import UserMaterial

if TYPE_CHECKING:
    from corota.arrays import Floats
    from corota.model.materials import Material


#: Increments of a path whose tangents are compared, and of one whose work is summed.
COARSE, FINE = 12, 400
#: Step of the differences, relative to the size of the strain.
STEP = 1e-5
#: Errors that are none, relative to the tangent at rest, the stress, the work.
TANGENT_ERROR, TURN_ERROR, ENERGY_ERROR = 1e-4, 1e-8, 2e-2
#: Angle by which a path is turned [rad].
ANGLE = 0.7
#: Outputs of laws that are work per volume beside the recoverable energy.
WORKS = ("PWORK", "CWORK", "DMENER")
#: Outputs of laws that never fall.
GROWING = {"PEEQ", "PDISS"}


def strain_paths(size: float) -> dict[str, Floats]:
    """Closed paths from the origin: rows xx, yy, xy at even places, each (n, 3)."""
    t = np.linspace(0.0, 1.0, 1001)
    cycle = np.interp(t, [0.0, 0.25, 0.75, 1.0], [0.0, 1.0, -1.0, 0.0])
    zero = np.zeros_like(t)
    turn = 2.0 * np.pi * np.clip((t - 0.2) / 0.6, 0.0, 1.0)
    radius = np.interp(t, [0.0, 0.2, 0.8, 1.0], [0.0, 1.0, 1.0, 0.0])
    return {
        "along x": size * np.stack([cycle, -0.3 * cycle, zero], axis=1),
        "both ways": size * np.stack([cycle, 0.6 * cycle, zero], axis=1),
        "shear": size * np.stack([zero, zero, 1.5 * cycle], axis=1),
        "turning": size
        * np.stack(
            [radius * np.cos(turn), -0.5 * radius * np.cos(turn), radius * np.sin(turn)], axis=1
        ),
    }


@dataclass(repr=False)
class LawCheck(Brief):
    """What one law showed in one plane.

    Parameters
    ----------
    name, plane : str
    tangent : float
        Largest difference of the tangent to central differences of the stress, symmetric parts,
        over the largest modulus at rest.
    asymmetry : float
        Largest skew part of the differences, likewise. An analysis takes the symmetric part.
    objectivity : float or None
        Largest difference of the stress along a turned path to the turned stress, over the largest
        stress; None for laws with axes of their own.
    energy : float or None
        Largest difference of the work of the stress to the recoverable energy and the plastic
        work, over the largest work; None for laws that do not give them.
    created : float
        Work gained in a closed cycle over the largest work; 0 if none is.
    curves : dict
        Strain and stress by path, each (n, 3), for the picture.
    repeats : bool
        Whether the same path gives the same stress again.
    falls : list of str
        Equivalent plastic strain or dissipation, where they fall along a path.
    """

    name: str
    plane: str
    tangent: float
    asymmetry: float
    objectivity: float | None
    energy: float | None
    created: float
    curves: dict[str, tuple[Floats, Floats]] = field(default_factory=dict, repr=False)
    repeats: bool = True
    falls: list[str] = field(default_factory=list)

    @property
    def faults(self) -> list[str]:
        """What is wrong, in words; empty for a good law."""
        found = []
        if not self.tangent <= TANGENT_ERROR:
            found.append(
                f"the tangent is not the derivative of the stress (off by {self.tangent:.1e})"
            )
        if self.objectivity is not None and not self.objectivity <= TURN_ERROR:
            found.append(
                f"the stress does not turn with the strain (off by {self.objectivity:.1e})"
            )
        if self.energy is not None and not self.energy <= ENERGY_ERROR:
            found.append(
                f"energy and plastic work are not the work of the stress ({self.energy:.1e})"
            )
        if not self.created <= ENERGY_ERROR:
            found.append(f"a closed cycle gains energy ({self.created:.1e} of its largest work)")
        if not self.repeats:
            found.append("the same strain path gives different stresses")
        found += [f"{name} falls along a path" for name in self.falls]
        return found


def check_material(
    material: Material, plane: str = "stress", size: float | None = None
) -> LawCheck:
    """Drive a law through strain paths.

    Parameters
    ----------
    material : Material
        A law of the core that is evaluated at points, or a :class:`~corota.UserMaterial`.
    plane : {"stress", "strain"}
    size : float, optional
        Largest strain; by default ten times that of first yield, else 0.02.

    Returns
    -------
    LawCheck

    Raises
    ------
    InputError
        If the law cannot be evaluated at a point.

    Examples
    --------
    >>> import corota as ct
    >>> from corota.check.material import check_material
    >>> check_material(ct.Mises(E=200e3, nu=0.3, yield_stress=250.0, isotropic=2e3)).faults
    []
    """
    if not hasattr(material, "respond"):
        raise InputError(
            f"a {type(material).__name__} is not evaluated at points: laws that are, such as "
            "Mises, and UserMaterial can be checked",
            material.where,
        )
    if size is None:
        first = getattr(material, "first_yield", None)
        size = 0.02 if first is None else 10.0 * float(first) * material.compliance()[0, 0]
    rest = _respond(material, np.zeros((1, 3)), plane)["tangent"][0]
    top = float(np.abs(rest).max())
    tangent = asymmetry = turned = created = 0.0
    energy: float | None = 0.0
    repeats = True
    falls: set[str] = set()
    curves = {}
    for name, whole in strain_paths(size).items():
        coarse = whole[np.linspace(0, len(whole) - 1, COARSE + 1).astype(int)[1:]]
        given = _respond(material, coarse, plane)["tangent"]
        exact = _differences(material, coarse, plane, STEP * size)
        skew = exact - np.swapaxes(exact, 1, 2)
        asymmetry = max(asymmetry, float(np.abs(skew).max()) / top)
        error = given + np.swapaxes(given, 1, 2) - exact - np.swapaxes(exact, 1, 2)
        # A path may meet a corner of the law: one row of differences across it says nothing.
        rows = np.sort(np.abs(error).max(axis=(1, 2)))
        tangent = max(tangent, 0.5 * float(rows[:-1].max()) / top)
        turned = max(turned, _turned(material, coarse, plane))
        fine = whole[np.linspace(0, len(whole) - 1, FINE + 1).astype(int)[1:]]
        answer = _respond(material, fine, plane)
        stress = answer["stress"]
        curves[name] = (fine, stress)
        repeats &= np.array_equal(stress, _respond(material, fine, plane)["stress"])
        for key in GROWING & answer.keys():
            least = -1e-12 * max(float(np.abs(answer[key]).max()), 1e-300)
            if np.diff(answer[key], prepend=0.0).min() < least:
                falls.add(key)
        before = np.vstack([np.zeros(3), fine[:-1]])
        mean = 0.5 * (stress + np.vstack([np.zeros(3), stress[:-1]]))
        work = np.cumsum(((fine - before) * mean).sum(axis=1))
        largest = float(np.abs(work).max()) or 1.0
        created = max(created, -float(work[-1]) / largest)
        if "energy" not in answer or (isinstance(material, UserMaterial) and material.members):
            # Functions with a history do not give their plastic work.
            energy = None
        elif energy is not None:
            given_work = answer["energy"] + sum(answer[key] for key in WORKS if key in answer)
            energy = max(energy, float(np.abs(work - given_work).max()) / largest)
    return LawCheck(
        material.name or type(material).__name__,
        plane,
        tangent,
        asymmetry,
        None if material.oriented else turned,
        energy,
        max(created, 0.0),
        curves,
        repeats,
        sorted(falls),
    )


def _respond(material: Any, path: Floats, plane: str) -> dict[str, Floats]:
    """Answer along a path; for laws that depend on it a time passes evenly."""
    if not material.depends_on_time:
        found: dict[str, Floats] = material.respond(path, plane)
        return found
    time = np.arange(1, len(path) + 1) / len(path)
    timed: dict[str, Floats] = material.respond(path, plane, time=time)
    return timed


def _differences(material: Any, path: Floats, plane: str, h: float) -> Floats:
    """Derivatives of the stress of each row by its strain, (n, 3, 3), by central differences."""
    found = np.zeros((len(path), 3, 3))
    for row in range(len(path)):
        for j in range(3):
            sides = []
            for sign in (1.0, -1.0):
                moved = path.copy()
                moved[row, j] += sign * h
                sides.append(_respond(material, moved, plane)["stress"][row])
            found[row, :, j] = (sides[0] - sides[1]) / (2.0 * h)
    return found


def _turned(material: Any, path: Floats, plane: str) -> float:
    """Largest difference of the stress along the turned path to the turned stress."""
    c, s = np.cos(ANGLE), np.sin(ANGLE)

    def turn(rows: Floats, shear: float) -> Floats:
        x, y, xy = rows[:, 0], rows[:, 1], shear * rows[:, 2]
        return np.stack(
            [
                c * c * x + s * s * y - 2 * c * s * xy,
                s * s * x + c * c * y + 2 * c * s * xy,
                (c * s * (x - y) + (c * c - s * s) * xy) / shear,
            ],
            axis=1,
        )

    stress = _respond(material, path, plane)["stress"]
    found = _respond(material, turn(path, 0.5), plane)["stress"]
    size = float(np.abs(stress).max()) or 1.0
    return float(np.abs(found - turn(stress, 1.0)).max()) / size
