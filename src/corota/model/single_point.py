"""Laws of the core at a single point: strain paths and uniaxial curves."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.model.materials import Material

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from corota.arrays import Floats


class SinglePoint(Material):
    """A law of the core that can be evaluated at a single point."""

    @property
    def small_at_points(self) -> bool:
        """Whether a single point is evaluated as in small displacements."""
        return False

    def respond(
        self,
        strain: ArrayLike,
        plane: str = "stress",
        time: ArrayLike = (),
        lasting: bool = True,
    ) -> dict[str, Floats]:
        """Response of a single point to a strain path, one implicit step per row.

        Parameters
        ----------
        strain : array_like, shape (n, 3)
            Rows xx, yy, xy (engineering shear).
        plane : {"stress", "strain"}
        time : array_like, shape (n,), optional
            Times of the rows after the start, for laws that depend on it; without it, none passes.
        lasting : bool
            Whether slow processes take part: creep and relaxation.

        Returns
        -------
        dict of ndarray
            ``stress`` (n, 3), ``tangent`` (n, 3, 3), ``zz`` (n, 2; strain and stress through
            the thickness), ``energy`` (n,), and the outputs of the law by name (n,).
        """
        import corota._core as _core

        path = np.ascontiguousarray(np.atleast_2d(np.asarray(strain, float)))
        n = len(path)
        raw: dict[str, Any] = _core.material_path(
            self.law,
            self.parameters(),
            plane,
            path,
            np.zeros(0),
            np.asarray(time, float).tolist(),
            0.0,
            lasting,
            self.small_at_points,
        )
        shapes = {"stress": (n, 3), "tangent": (n, 3, 3), "derivative": (n, 3, 3), "zz": (n, 2)}
        shapes["state"] = (n, -1)
        return {key: values.reshape(shapes.get(key, (n,))) for key, values in raw.items()}


class LawOfTheCore(SinglePoint, ABC):
    """A plastic law."""

    E: float

    flows = True

    @property
    @abstractmethod
    def first_yield(self) -> float:
        """Uniaxial stress where plastic strain begins or becomes noticeable [force/length^2]."""

    def uniaxial(
        self, strain: ArrayLike, time: ArrayLike | None = None, lasting: bool = True
    ) -> Floats:
        """Uniaxial stress along a path of axial strains.

        Parameters
        ----------
        strain : array_like, shape (n,)
        time, lasting
            As in :meth:`respond`.

        Returns
        -------
        ndarray, shape (n,)
            Axial stress [force/length^2]; the transverse one is zero.
        """
        import corota._core as _core

        state = np.zeros(0)
        side = before = 0.0
        out = []
        path = np.asarray(strain, float)
        times = np.zeros(len(path)) if time is None else np.asarray(time, float)
        for axial, now in zip(path, times, strict=True):
            for _ in range(50):
                point = np.array([[axial, side, 0.0]])
                raw = _core.material_path(
                    self.law, self.parameters(), "stress", point, state, [now], before, lasting
                )
                step = raw["stress"][1] / raw["tangent"][4]
                if abs(raw["stress"][1]) <= 1e-12 * (abs(raw["stress"][0]) + 1e-12 * self.E):
                    break
                side -= step
            state, before = raw["state"], now
            out.append(raw["stress"][0])
        return np.array(out)

    def plot_uniaxial(self, strain: ArrayLike | None = None, ax: Any = None) -> Any:
        """Draw uniaxial stress against strain.

        Parameters
        ----------
        strain : array_like, shape (n,), optional
            Path of axial strains; by default one loop over ten times the yield strain.
        ax : matplotlib.axes.Axes, optional

        Returns
        -------
        matplotlib.axes.Axes
        """
        import matplotlib.pyplot as plt

        if strain is None:
            top = 10.0 * self.first_yield / self.E
            strain = np.concatenate(
                [np.linspace(0, top, 60), np.linspace(top, -top, 120), np.linspace(-top, top, 120)]
            )
        path = np.asarray(strain, float)
        ax = ax or plt.figure().add_subplot()
        ax.plot(path, self.uniaxial(path))
        ax.set_xlabel("strain")
        ax.set_ylabel("stress [force/length^2]")
        ax.set_title(self.name or "uniaxial answer")
        return ax
