"""Material laws as plain parameters, checked at construction."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from corota.display import Brief
from corota.errors import InputError, Location, number

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from corota.arrays import Floats
    from corota.model.local_strain import LocalStrain


def isotropic_compliance(E: ArrayLike, nu: ArrayLike) -> Floats:
    """Compliance of isotropic elasticity, rows xx, yy, zz, xy, shape (..., 4, 4)."""
    young, poisson = np.asarray(E, dtype=np.float64), np.asarray(nu, dtype=np.float64)
    s = np.zeros((*young.shape, 4, 4))
    s[..., :3, :3] = (-poisson / young)[..., None, None]
    for i in range(3):
        s[..., i, i] = 1.0 / young
    s[..., 3, 3] = 2.0 * (1.0 + poisson) / young
    return s


@dataclass(frozen=True, repr=False)
class Expansion(Brief):
    """Thermal expansion, constant or a table over the temperature.

    The thermal strain is ``alpha(T) (T - zero) - alpha(T0) (T0 - zero)`` with the temperature
    ``T`` and the initial one ``T0``: coefficients of tables are means from ``zero`` on.

    Parameters
    ----------
    alpha : sequence
        A coefficient [1/temperature], or three for the material axes 1, 2 and 3; one entry for
        each temperature of the table.
    temperature : sequence of float
        Increasing temperatures of the entries; empty for one entry. Constant outside.
    zero : float
        Temperature from which the coefficients count.

    Notes
    -----
    As ``*EXPANSION, ZERO=`` of CalculiX and Abaqus.
    """

    alpha: tuple[float | tuple[float, float, float], ...]
    temperature: tuple[float, ...] = ()
    zero: float = 0.0

    @staticmethod
    def of(value: float | tuple[float, float, float] | Expansion) -> Expansion:
        """An expansion from one or three coefficients."""
        return value if isinstance(value, Expansion) else Expansion((value,))

    def __post_init__(self) -> None:
        table = np.asarray(self.temperature, dtype=np.float64)
        try:
            finite = bool(np.isfinite(self._rows()).all() and np.isfinite(table).all())
        except (ValueError, TypeError):
            finite = False
        if not (finite and np.isfinite(self.zero)):
            raise InputError(f"one or three finite coefficients are expected, not {self.alpha}")
        if len(self.alpha) != max(len(table), 1) or (table[1:] <= table[:-1]).any():
            raise InputError(
                "each coefficient of a table needs a temperature, and the temperatures must "
                "increase"
            )

    def _rows(self) -> Floats:
        rows = np.empty((len(self.alpha), 3))
        for row, alpha in zip(rows, self.alpha, strict=True):
            row[:] = alpha
        return rows

    def __bool__(self) -> bool:
        return bool(self._rows().any())

    def strain(self, temperature: ArrayLike, start: ArrayLike) -> Floats:
        """Thermal strain along the material axes, shape (..., 3)."""
        rows = self._rows()

        def from_zero(at: ArrayLike) -> Floats:
            now = np.asarray(at, dtype=np.float64)
            if len(rows) == 1:
                alpha = np.broadcast_to(rows[0], (*now.shape, 3))
            else:
                columns = [np.interp(now, self.temperature, rows[:, i]) for i in range(3)]
                alpha = np.stack(columns, axis=-1)
            return np.asarray(alpha * (now - self.zero)[..., None])

        return from_zero(temperature) - from_zero(start)


@dataclass(repr=False)
class Material(Brief):
    """Common data of all materials.

    Parameters
    ----------
    rho : float
        Mass density [mass/length^3]; 0 means that none was given.
    expansion : float, tuple of three floats or Expansion
        Thermal expansion [1/temperature], or that along the material axes.
    rayleigh : tuple of float
        Damping of this material per mass [1/time] and per stiffness [time].
    name : str
        The user's name.
    where : Location, optional
        Card that defined it.
    """

    rho: float = field(default=0.0, kw_only=True)
    expansion: float | tuple[float, float, float] | Expansion = field(default=0.0, kw_only=True)
    rayleigh: tuple[float, float] = field(default=(0.0, 0.0), kw_only=True)
    name: str = field(default="", kw_only=True)
    where: Location | None = field(default=None, kw_only=True, compare=False, repr=False)

    #: Name of the law in the core.
    law = ""
    #: Whether the law has plastic flow.
    flows = False
    #: Whether stress is a linear function of strain.
    linear = False
    #: Whether the stress depends on the strain path.
    remembers = True
    #: Whether it has material axes.
    oriented = False
    #: The only measure of the local strain that it is for; empty for any.
    local_strain: ClassVar[LocalStrain | Literal[""]] = ""
    #: Whether trusses and beams support it.
    for_lines = False
    #: Whether it has a stress for a strain in all directions, as solids of revolution need.
    for_rings = True
    #: Whether its constants follow the temperature.
    follows_temperature = False
    #: Whether its answer depends on the time that passes.
    depends_on_time = False
    #: Whether it creeps without end under constant stress.
    creeps = False
    #: How many of its first parameters make the elastic or complementary energy; 0 for a law whose
    #: constants are unknown.
    elastic_constants = 0

    @property
    def incompressible(self) -> bool:
        """Whether the volume is constant; possible in plane stress only."""
        return False

    @property
    def default_strain(self) -> LocalStrain:
        """Local strain of sections that name none: the law's own, else by whether it flows."""
        return self.local_strain or ("logarithmic" if self.flows else "linear")

    def compliance(self) -> Floats:
        """Elastic compliance along the material axes, rows 11, 22, 33, 12, shape (4, 4).

        Shear is engineering shear.
        """
        if self.elastic_constants:
            return self.compliance_of(np.array(self.parameters()[: self.elastic_constants]))
        raise InputError(
            f"a material of type {type(self).__name__} has no elastic constants for thermal "
            "strain or initial stress; include them in the function itself",
            self.where,
        )

    @staticmethod
    def compliance_of(constants: Floats) -> Floats:
        """Elastic compliance (..., 4, 4) of the first parameters (..., elastic_constants)."""
        return isotropic_compliance(constants[..., 0], constants[..., 1])

    @classmethod
    def complementary_of(cls, constants: Floats, stress: Floats) -> Floats:
        """Complementary energy by volume of stresses (..., 4) along the material axes."""
        strain = np.einsum("...ij,...j->...i", cls.compliance_of(constants), stress)
        return 0.5 * np.asarray(np.sum(strain * stress, axis=-1))

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """Numbers passed to the core, in the order documented in the law's file.

        Parameters
        ----------
        orientation : float, optional
            Angle of the material axes [rad]; without effect on isotropic laws.
        """
        raise TypeError(f"{type(self).__name__} has no parameters")

    def _check_isotropic(self, E: float, nu: float) -> None:
        number(E, "Young's modulus E", self.where, above=0.0)
        if not -1.0 < nu < 0.5:
            raise InputError(
                f"Poisson's ratio {nu} is outside -1 < nu < 0.5; "
                "for a nearly incompressible material use e.g. 0.4999",
                self.where,
            )

    def _check_motion(self) -> None:
        number(self.rho, "the density", self.where, least=0.0)
        if not (len(self.rayleigh) == 2 and all(0.0 <= c < math.inf for c in self.rayleigh)):
            raise InputError(
                f"rayleigh damping is a pair of numbers >= 0, not {self.rayleigh}", self.where
            )


@dataclass
class Elastic(Material):
    """Isotropic linear elasticity.

    Parameters
    ----------
    E : float
        Young's modulus [force/length^2], > 0.
    nu : float
        Poisson's ratio, -1 < nu < 1/2.

    Raises
    ------
    InputError
        If a constant is outside its range.
    """

    E: float
    nu: float = 0.0

    law = "elastic"
    linear, remembers = True, False
    for_lines = True
    elastic_constants = 2

    def __post_init__(self) -> None:
        self._check_isotropic(self.E, self.nu)
        self._check_motion()

    def parameters(self, orientation: float = 0.0) -> list[float]:
        return [self.E, self.nu]


@dataclass
class Orthotropic(Material):
    """Orthotropic linear elasticity; axes 1 and 2 in the plane, 3 normal to it.

    The angle of axis 1 belongs to the section (``orientation``).

    Parameters
    ----------
    E1, E2, E3 : float
        Young's moduli [force/length^2], > 0.
    nu12, nu13, nu23 : float
        Poisson's ratios; ``nu12`` is the contraction along 2 under tension along 1.
    G12 : float
        Shear modulus in the plane [force/length^2], > 0.

    Raises
    ------
    InputError
        If the compliance is not positive definite.

    Notes
    -----
    Source: R. M. Jones, *Mechanics of Composite Materials*, 2nd ed., section 2.4.
    """

    E1: float
    E2: float
    E3: float
    nu12: float
    nu13: float
    nu23: float
    G12: float

    law = "orthotropic"
    linear, remembers, oriented = True, False, True
    elastic_constants = 7

    def __post_init__(self) -> None:
        for name in ("E1", "E2", "E3", "G12"):
            number(getattr(self, name), name, self.where, above=0.0)
        s12, s13, s23 = -self.nu12 / self.E1, -self.nu13 / self.E1, -self.nu23 / self.E2
        s11, s22, s33 = 1.0 / self.E1, 1.0 / self.E2, 1.0 / self.E3
        minor = s11 * s22 - s12 * s12
        det = (
            s11 * (s22 * s33 - s23 * s23)
            - s12 * (s12 * s33 - s23 * s13)
            + s13 * (s12 * s23 - s22 * s13)
        )
        if not (minor > 0.0 and det > 0.0):
            raise InputError(
                "the orthotropic constants are not positive definite; the Poisson's ratios are "
                f"too large (|nu12| must be below {math.sqrt(self.E1 / self.E2):g})",
                self.where,
            )
        self._check_motion()

    @staticmethod
    def compliance_of(constants: Floats) -> Floats:
        e1, e2, e3, nu12, nu13, nu23, g12 = np.moveaxis(constants, -1, 0)
        s = np.zeros((*e1.shape, 4, 4))
        for i, modulus in enumerate((e1, e2, e3, g12)):
            s[..., i, i] = 1.0 / modulus
        s[..., 0, 1] = s[..., 1, 0] = -nu12 / e1
        s[..., 0, 2] = s[..., 2, 0] = -nu13 / e1
        s[..., 1, 2] = s[..., 2, 1] = -nu23 / e2
        return s

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """``E1, E2, E3, nu12, nu13, nu23, G12``, angle of axis 1 from x [rad]."""
        moduli = [self.E1, self.E2, self.E3]
        return [*moduli, self.nu12, self.nu13, self.nu23, self.G12, orientation]
