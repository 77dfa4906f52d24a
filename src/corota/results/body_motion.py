"""Motion of a group of nodes as a rigid body: rotation, displacement of any point, centers."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from corota.display import Brief
from corota.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from corota.arrays import Floats


#: Rotation [rad] below which a center of rotation has no place.
LEAST_ROTATION = 1e-9


@dataclass
class BodyMotion(Brief):
    """Best-fit rigid motion of a group of nodes, by frame.

    Parameters
    ----------
    center : ndarray, shape (2,)
        Mean of the nodes, undeformed [length].
    translation : ndarray, shape (n_frames, 2)
        Displacement of `center` [length].
    rotation : ndarray, shape (n_frames,)
        Least-squares rotation [rad], continuous over the frames: whole turns count.
    distortion : ndarray, shape (n_frames,)
        Root mean square distance of the nodes from the rigid motion [length].
    """

    center: Floats
    translation: Floats
    rotation: Floats
    distortion: Floats

    def displacement(self, point: ArrayLike) -> Floats:
        """Displacement of a point that moves with the body, shape (n_frames, 2) [length].

        Parameters
        ----------
        point : array_like, shape (2,)
            Its undeformed place [length].
        """
        arm = np.asarray(point, dtype=np.float64) - self.center
        cos, sin = np.cos(self.rotation), np.sin(self.rotation)
        turned = np.column_stack([cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1]])
        return np.asarray(self.translation + turned - arm)

    @property
    def pole(self) -> Floats:
        """Center of the finite rotation from the undeformed place, shape (n_frames, 2) [length].

        NaN where the body has not turned.
        """
        half = 0.5 * self.rotation
        turned = np.abs(np.sin(half)) > LEAST_ROTATION
        cot = np.full_like(half, np.nan)
        cot[turned] = np.cos(half[turned]) / np.sin(half[turned])
        across = np.column_stack([-self.translation[:, 1], self.translation[:, 0]])
        return np.asarray(self.center + 0.5 * (self.translation + cot[:, None] * across))

    @property
    def instant_center(self) -> Floats:
        """Point at rest in each frame, shape (n_frames, 2) [length].

        From the change of translation with rotation: central differences over the frames,
        one-sided at the first and the last. NaN where the body does not turn.
        """
        if len(self.rotation) < 2:
            return np.full((len(self.rotation), 2), np.nan)
        rotates = np.abs(np.gradient(self.rotation)) > LEAST_ROTATION
        found = np.full((len(self.rotation), 2), np.nan)
        if rotates.all():
            rate = np.gradient(self.translation, self.rotation, axis=0, edge_order=1)
            place = self.center + self.translation
            found = place + np.column_stack([-rate[:, 1], rate[:, 0]])
        return np.asarray(found)


def fit_rigid_motion(points: Floats, U: Floats, UR: Floats) -> BodyMotion:
    """Least-squares rigid motion of nodes.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Undeformed places [length].
    U : ndarray, shape (n_frames, n, 2)
        Displacements [length].
    UR : ndarray, shape (n_frames, n)
        Rotations of the nodes [rad], used where all nodes lie at one place.

    Raises
    ------
    InputError
        If the nodes lie at one place and do not rotate.
    """
    center = points.mean(axis=0)
    arms = points - center
    translation = U.mean(axis=1)
    if not arms.any():
        turns = UR.mean(axis=1)
        if not turns.any():
            raise InputError(
                "the rotation of a body needs two nodes at different places, or a node that rotates"
            )
        return BodyMotion(center, translation, turns, np.zeros(len(turns)))
    moved = arms + U - translation[:, None]
    along = np.einsum("ni,fni->f", arms, moved)
    across = (arms[:, 0] * moved[..., 1] - arms[:, 1] * moved[..., 0]).sum(axis=1)
    angle = np.arctan2(across, along)
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.array([[cos, -sin], [sin, cos]])
    error = moved - np.einsum("ijf,nj->fni", turn, arms)
    distortion = np.sqrt((error**2).sum(axis=2).mean(axis=1))
    return BodyMotion(center, translation, np.unwrap(angle), distortion)
