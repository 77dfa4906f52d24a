"""Results of one stage: its path as arrays, pseudo-rigid body, table of a nonlinear spring."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from corota.display import Brief
from corota.errors import InputError
from corota.lazy import lazy
from corota.results.measures import COMPONENTS

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import ArrayLike

    from corota.arrays import Floats
    from corota.results.source import ResultSource


# A convenience: a function of a higher layer, which loads at its first call.
write_spring = lazy("corota.io.tables.spring:write_spring")

#: Share of the largest motion below which a component does not move.
STILL = 1e-9


@dataclass(repr=False)
class PseudoRigidBody(Brief):
    """A rigid link on a pin with a torsion spring, fitted to the path of a stage.

    The reference point moves on a circle about the pin. Its angle is that of the link, which is
    not the rotation of the stage: a leaf under an end force turns by 1.24 times the angle.

    Parameters
    ----------
    pivot : ndarray, shape (2,)
        Place of the pin [length].
    radius : float
        Characteristic radius: length of the link [length].
    stiffness : float
        Of the spring: moment about the pin per angle of the link [force*length/rad].
    rotation_ratio : float
        Rotation of the stage over the angle of the link.
    angle, moment : ndarray, shape (n_frames,)
        Of the link [rad], about the pin [force*length].
    path_error : float
        Root mean square distance of the reference point from the circle over the radius.
    moment_error : float
        Root mean square difference of the moments from those of the spring over the largest.
    """

    pivot: Floats
    radius: float
    stiffness: float
    rotation_ratio: float
    angle: Floats = field(repr=False)
    moment: Floats = field(repr=False)
    path_error: float
    moment_error: float


@dataclass(repr=False)
class StageResults(Brief):
    """The path of a stage, of results in memory or in a file.

    Parameters
    ----------
    name : str
    reference : ndarray, shape (2,)
        Undeformed place of the reference point [length].
    motion : ndarray, shape (n_frames, 3)
        Displacement of the reference point along x and y, and rotation.
    force : ndarray, shape (n_frames, 3)
        Force and moment on the stage.
    stiffness : ndarray, shape (n_frames, 3, 3)
        Tangent stiffness, NaN where it was not computed.
    travel, load : ndarray, shape (n_frames,)
        Along the axis of the stage.
    """

    name: str
    reference: Floats
    motion: Floats
    force: Floats
    stiffness: Floats
    travel: Floats
    load: Floats

    @property
    def compliance(self) -> Floats:
        """Inverse of the stiffness, shape (n_frames, 3, 3).

        Raises
        ------
        InputError
            If a stiffness is unknown or singular.
        """
        try:
            if np.isfinite(self.stiffness).all():
                return np.asarray(np.linalg.inv(self.stiffness))
        except np.linalg.LinAlgError:
            pass
        raise InputError(f"stage {self.name!r}: the stiffness of a frame is unknown or singular")

    def pseudo_rigid_body(self, along: ArrayLike | None = None) -> PseudoRigidBody:
        """Fit a rigid link with a torsion spring to the path by least squares.

        Parameters
        ----------
        along : array_like, shape (2,), optional
            Direction from the pin to the undeformed reference point, such as that of a straight
            leaf; without one the pin may be anywhere.

        Returns
        -------
        PseudoRigidBody

        Raises
        ------
        InputError
            If the reference point does not move, or moves on a straight line.

        Notes
        -----
        The circle passes through the undeformed reference point: its center p minimizes the sum of
        (|x - p|^2 - |x0 - p|^2)^2, which is linear in p. The spring minimizes the sum of
        (moment - stiffness * angle)^2. After Howell, Compliant Mechanisms (2001), chapter 5.
        """
        moved = self.motion[:, :2]
        size = float(np.abs(moved).max(initial=0.0))
        squares = (moved**2).sum(axis=1)
        way = 2.0 * moved
        if along is not None:
            unit = np.asarray(along, dtype=np.float64)
            unit = unit / np.hypot(*unit)
            # With p = x0 - r e: |x - x0|^2 = - 2 r e (x - x0).
            way = -way @ unit[:, None]
        if size == 0.0 or np.linalg.matrix_rank(way, tol=1e-9 * size) < way.shape[1]:
            raise InputError(
                f"stage {self.name!r}: its reference point moves on no circle; give the direction "
                "of the link, or take the stiffness"
            )
        found = np.linalg.lstsq(way, squares, rcond=None)[0]
        arm = -unit * found[0] if along is not None else found
        pivot = self.reference + arm
        first = -arm
        radius = float(np.hypot(*first))
        links = first + moved
        cross = first[0] * links[:, 1] - first[1] * links[:, 0]
        angle = np.unwrap(np.arctan2(cross, links @ first))
        force = self.force
        moment = links[:, 0] * force[:, 1] - links[:, 1] * force[:, 0] + force[:, 2]
        stiffness = float(moment @ angle / (angle @ angle))
        distance = np.hypot(*links.T) - radius
        largest = float(np.abs(moment).max()) or 1.0
        return PseudoRigidBody(
            pivot,
            radius,
            stiffness,
            float(self.motion[:, 2] @ angle / (angle @ angle)),
            angle,
            moment,
            float(np.sqrt((distance**2).mean()) / radius),
            float(np.sqrt(((moment - stiffness * angle) ** 2).mean()) / largest),
        )

    def write(self, path: str | PathLike[str]) -> Path:
        """Write the stage as a nonlinear spring; see :func:`corota.io.tables.spring.write_spring`.

        Parameters
        ----------
        path : path-like
            ``.csv``: motion, force and stiffness of each frame; ``.inp``: cards of springs.

        Raises
        ------
        InputError
            If the ending is unknown, or a spring would have two forces at one elongation.
        FileError
            If the file cannot be written.
        """
        written: Path = write_spring(self, Path(path))
        return written


def stage_results(results: ResultSource, name: str) -> StageResults:
    """Path of a stage; see :meth:`corota.results.Results.stage`."""

    def column(measure: str) -> Floats:
        return np.asarray(results.history(measure, at=name or None).values)

    motion = np.stack([column(m) for m in ("motion x", "motion y", "rotation")], axis=1)
    force = np.stack([column(m) for m in ("force x", "force y", "moment")], axis=1)
    rows = [[column(f"stiffness {a}{b}") for b in COMPONENTS] for a in COMPONENTS]
    reference = np.array([column("place x")[0], column("place y")[0]]) - motion[0, :2]
    stiffness = np.moveaxis(np.array(rows), 2, 0)
    return StageResults(name, reference, motion, force, stiffness, column("travel"), column("load"))
