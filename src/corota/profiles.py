"""Cross-sections of beams: their numbers, and the fibers that plastic beams are made of.

A profile is cut into layers across its height. Each layer becomes two fibers of half its area at
the distance of its radius of gyration on both sides of its centroid, so that area, second moment
and plastic moment are exact.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from corota.display import Brief
from corota.errors import InputError, number

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike

    from corota.arrays import Floats

    #: Area, first and second moment about 0 of what lies below a height.
    Moments = Callable[[float], Floats]

#: Shear areas as fractions of the area (Cowper 1966, without Poisson's ratio).
RECTANGLE, CIRCLE, TUBE = 5.0 / 6.0, 0.9, 0.5
#: Layers across the height.
LAYERS = 16


@dataclass(frozen=True, repr=False)
class Profile(Brief):
    """Cross-section of a beam in the plane; its centroid lies on the axis.

    Parameters
    ----------
    area : float
        [length^2]
    inertia : float
        Second moment [length^4].
    shear_area : float
        Shear area [length^2]; 0 for no shear deformation.
    height : float
        [length]
    fibers : ndarray, shape (n, 3)
        Distance from the axis to the left of the way from the first to the second node [length],
        rising; area [length^2]; initial stress [force/length^2]. Fibers at the surfaces have no
        area: they show stress and strain there.
    """

    area: float
    inertia: float
    shear_area: float
    height: float
    fibers: Floats = field(repr=False, compare=False)

    @property
    def rows(self) -> tuple[tuple[float, float, float], ...]:
        """The fibers as plain numbers."""
        return tuple((float(y), float(a), float(s)) for y, a, s in self.fibers)

    @property
    def fiber(self) -> float:
        """Distance of both outer fibers from the axis [length]; 0 where they differ."""
        low, high = -float(self.fibers[0, 0]), float(self.fibers[-1, 0])
        return high if math.isclose(low, high, rel_tol=1e-9) else 0.0

    @property
    def plastic_modulus(self) -> float:
        """Plastic moment without axial force over the yield stress [length^3]."""
        y, area, _ = self.fibers.T
        # The axis that halves the area, anywhere between two fibers.
        middle = y[np.searchsorted(np.cumsum(area), 0.5 * area.sum())]
        return float(np.abs(y - middle) @ area)

    @property
    def shape_factor(self) -> float:
        """Plastic moment over that at first yield."""
        return self.plastic_modulus * float(np.abs(self.fibers[:, 0]).max()) / self.inertia

    def with_stress(self, stress: Callable[[Floats], ArrayLike] | ArrayLike) -> Profile:
        """The same profile with an initial stress, such as that of rolling or cold forming.

        Parameters
        ----------
        stress : callable or array_like, shape (n,)
            Axial stress [force/length^2] as a function of the distances of the fibers from the
            axis, or by fiber. Where its resultants are not zero, the part deforms in the first
            increment.

        Returns
        -------
        Profile
        """
        values = stress(self.fibers[:, 0]) if callable(stress) else stress
        fibers = self.fibers.copy()
        fibers[:, 2] = np.asarray(values, dtype=np.float64)
        if not np.isfinite(fibers).all():
            raise InputError("the initial stress of a profile must be finite")
        return replace(self, fibers=fibers)


def rectangle(width: float, height: float, *, layers: int = LAYERS) -> Profile:
    """A rectangle.

    Parameters
    ----------
    width : float
        Size out of the plane [length].
    height : float
        Size in the plane [length].
    layers : int, optional
        Layers across the height.

    Returns
    -------
    Profile
    """
    w, h = _sizes(width=width, height=height)
    return _layered([_wall(w, -0.5 * h, 0.5 * h)], RECTANGLE * w * h, layers, (-0.5 * h, 0.5 * h))


def circle(diameter: float, *, width: float | None = None, layers: int = LAYERS) -> Profile:
    """A circle, or an ellipse with another size out of the plane.

    Parameters
    ----------
    diameter : float
        Size in the plane [length].
    width : float, optional
        Size out of the plane [length]; by default the diameter.
    layers : int, optional
        Layers across the height.

    Returns
    -------
    Profile
    """
    d, w = _sizes(diameter=diameter, width=diameter if width is None else width)
    part = _disc(0.5 * d, w / d)
    return _layered([part], CIRCLE * 0.25 * math.pi * d * w, layers, (-0.5 * d, 0.5 * d))


def pipe(radius: float, thickness: float, *, layers: int = LAYERS) -> Profile:
    """A tube.

    Parameters
    ----------
    radius : float
        Outer radius [length].
    thickness : float
        Thickness of the wall [length], at most the radius.
    layers : int, optional
        Layers across the height.

    Returns
    -------
    Profile
    """
    r, t = _sizes(radius=radius, thickness=thickness)
    if t > r:
        raise InputError("the thickness exceeds the radius")
    parts = [_disc(r, 1.0)]
    if t < r:
        parts.append(_disc(r - t, -1.0))
    area = math.pi * (r * r - (r - t) ** 2)
    return _layered(parts, TUBE * area, layers, (-r, r))


def box(
    width: float, height: float, walls: float | Sequence[float], *, layers: int = LAYERS
) -> Profile:
    """A box.

    Parameters
    ----------
    width, height : float
        Outer sizes out of the plane and in it [length].
    walls : float or sequence of four floats
        Thicknesses [length]: of all walls; or of the right, top, left and bottom one, with the
        top on the left of the way from the first to the second node.
    layers : int, optional
        Layers across the height.

    Returns
    -------
    Profile
    """
    four = [float(t) for t in np.broadcast_to(np.asarray(walls, dtype=float), 4)]
    w, h, *_ = _sizes(
        width=width, height=height, **{f"wall {i + 1}": t for i, t in enumerate(four)}
    )
    right, top, left, bottom = four
    if w <= left + right or h <= top + bottom:
        raise InputError("the walls fill the box")
    inside = w - left - right
    return of_rectangles(
        [(right + left, 0.0, h), (inside, 0.0, bottom), (inside, h - top, h)], layers=layers
    )


def i_section(
    height: float,
    widths: float | Sequence[float],
    flanges: float | Sequence[float],
    web: float,
    *,
    layers: int = LAYERS,
) -> Profile:
    """An I, bent about its strong axis; with a lower or upper width of the web a T.

    Parameters
    ----------
    height : float
        [length]
    widths, flanges : float or pair of floats
        Width and thickness of the flanges [length]: of both, or of the lower and the upper one
        (left of the way from the first to the second node).
    web : float
        Thickness of the web [length].
    layers : int, optional
        Layers across the height.

    Returns
    -------
    Profile
    """
    low, high = (float(v) for v in np.broadcast_to(np.asarray(widths, dtype=float), 2))
    t_low, t_high = (float(v) for v in np.broadcast_to(np.asarray(flanges, dtype=float), 2))
    h, t, *_ = _sizes(
        height=height,
        web=web,
        **{"lower width": low, "upper width": high},
        **{"lower flange": t_low, "upper flange": t_high},
    )
    if h <= t_low + t_high:
        raise InputError("the flanges fill the height")
    return of_rectangles(
        [(low, 0.0, t_low), (t, t_low, h - t_high), (high, h - t_high, h)], layers=layers
    )


def of_rectangles(parts: Sequence[tuple[float, float, float]], *, layers: int = LAYERS) -> Profile:
    """A profile of rectangles.

    Parameters
    ----------
    parts : sequence of (width, bottom, top)
        Sizes out of the plane, and places in it from any line on [length]. Those that are higher
        than wide carry the shear force; without one, 5/6 of the area.
    layers : int, optional
        Layers across the height.

    Returns
    -------
    Profile
    """
    area = sum(w * (t - b) for w, b, t in parts)
    if not (math.isfinite(area) and all(w > 0.0 and t > b for w, b, t in parts)):
        raise InputError("a profile of rectangles needs widths > 0 and tops above the bottoms")
    center = sum(0.5 * w * (t * t - b * b) for w, b, t in parts) / area
    placed = [(w, b - center, t - center) for w, b, t in parts]
    shear = sum(w * (t - b) for w, b, t in parts if t - b > w) or RECTANGLE * area
    edges = tuple(v for _, b, t in placed for v in (b, t))
    return _layered([_wall(*part) for part in placed], shear, layers, edges)


def of_fibers(fibers: ArrayLike, *, shear_area: float = 0.0) -> Profile:
    """A profile of given fibers.

    Parameters
    ----------
    fibers : array_like, shape (n, 2)
        Distance from any line [length] and area [length^2], >= 0. The axis passes through their
        centroid.
    shear_area : float, optional
        Shear area [length^2]; 0 for no shear deformation.

    Returns
    -------
    Profile
    """
    rows = np.array(fibers, dtype=np.float64)
    good = rows.ndim == 2 and rows.shape[1:] == (2,) and np.isfinite(rows).all()
    if not good or (rows[:, 1] < 0.0).any() or len(np.unique(rows[rows[:, 1] > 0.0, 0])) < 2:
        raise InputError(
            "fibers are rows of (distance, area) with areas >= 0, at two distances at least"
        )
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    y, area = rows.T
    y = y - (y @ area) / area.sum()
    number(shear_area, "the shear area", least=0.0)
    table = np.stack([y, area, np.zeros_like(y)], axis=1)
    return Profile(
        float(area.sum()), float(area @ y**2), float(shear_area), float(np.ptp(y)), table
    )


def _sizes(**sizes: float) -> list[float]:
    """Sizes as numbers, refused unless positive."""
    return [number(value, f"the {name}", above=0.0) for name, value in sizes.items()]


def _wall(width: float, bottom: float, top: float) -> Moments:
    def below(y: float) -> Floats:
        end = min(max(y, bottom), top)
        return width * np.array([end**k - bottom**k for k in (1, 2, 3)]) / [1.0, 2.0, 3.0]

    return below


def _disc(radius: float, factor: float) -> Moments:
    def below(y: float) -> Floats:
        end = min(max(y, -radius), radius)
        root, angle = math.sqrt(max(radius**2 - end**2, 0.0)), math.asin(end / radius)
        area = end * root + radius**2 * (angle + 0.5 * math.pi)
        first = -2.0 / 3.0 * root**3
        second = 0.25 * (end * (2.0 * end**2 - radius**2) * root)
        second += 0.25 * radius**4 * (angle + 0.5 * math.pi)
        return factor * np.array([area, first, second])

    return below


def _layered(
    parts: Sequence[Moments], shear_area: float, layers: int, edges: tuple[float, ...]
) -> Profile:
    """Cut a profile into layers, also at its edges and where the area is halved."""
    if not (isinstance(layers, int | np.integer) and layers > 0):
        raise InputError(f"the number of layers must be at least 1, not {layers!r}")

    def below(y: float) -> Floats:
        return np.asarray(sum(part(y) for part in parts))

    bottom, top = min(edges), max(edges)
    area, _, inertia = (float(v) for v in below(top))
    low, high = bottom, top
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if below(middle)[0] > 0.5 * area else (middle, high)
    # Also at the edges and where the area is halved, unless rounding alone separates two cuts.
    cuts = np.sort([*np.linspace(bottom, top, layers + 1), *edges, 0.5 * (low + high)])
    cuts = cuts[np.diff(cuts, prepend=-np.inf) > 1e-9 * (top - bottom)]
    fibers = [(bottom, 0.0, 0.0)]
    for start, end in zip(cuts[:-1], cuts[1:], strict=True):
        a, s, i = below(end) - below(start)
        if a > 1e-12 * area:
            center = s / a
            radius = math.sqrt(max(i / a - center**2, 0.0))
            fibers += [(center - radius, 0.5 * a, 0.0), (center + radius, 0.5 * a, 0.0)]
    fibers.append((top, 0.0, 0.0))
    return Profile(area, inertia, shear_area, top - bottom, np.array(fibers))


__all__ = [
    "CIRCLE",
    "LAYERS",
    "RECTANGLE",
    "TUBE",
    "Profile",
    "box",
    "circle",
    "i_section",
    "of_fibers",
    "of_rectangles",
    "pipe",
    "rectangle",
]
