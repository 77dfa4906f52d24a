"""Hyperelastic laws: rubber and foam."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from abc import ABC
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from corota.errors import InputError
from corota.model.materials import isotropic_compliance
from corota.model.single_point import SinglePoint

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike
    from typing_extensions import Self

    from corota.arrays import Bools, Floats


#: Powers of both invariants of the polynomial law, in the order of its coefficients.
POWERS = ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3))
#: Second strain over the first of the tests of sheets; of the uniaxial one at constant volume.
TESTS = {"uniaxial": -0.5, "biaxial": 1.0, "planar": 0.0}
#: Most terms of Ogden's law and of the foam.
MAX_TERMS = 6


@dataclass
class Hyperelastic(SinglePoint, ABC):
    """A law given by its energy density; stress and tangent follow from it."""

    local_strain = "logarithmic"
    remembers = False

    def __post_init__(self) -> None:
        self._check_motion()
        numbers = np.asarray(self.parameters(), float)
        if not np.isfinite(numbers).all():
            raise InputError(f"{type(self).__name__}: a constant is not finite", self.where)
        from corota import _core

        # The core checks the constants; constant volume only where it is possible.
        path = np.zeros((1, 3))
        try:
            _core.material_path(self.law, list(numbers), "stress", path, np.zeros(0))
        except ValueError as error:
            raise InputError(str(error), self.where) from None

    @property
    def shear_modulus(self) -> float:
        """Shear modulus at small strain [force/length^2]."""
        return float(self.respond([0.0, 0.0, 0.0])["tangent"][0, 2, 2])

    @property
    def bulk_modulus(self) -> float:
        """Bulk modulus at small strain [force/length^2]; infinite at constant volume."""
        if self.incompressible:
            return math.inf
        tangent = self.respond([0.0, 0.0, 0.0], "strain")["tangent"][0]
        return float(tangent[0, 0] - 4.0 / 3.0 * tangent[2, 2])

    def compliance(self) -> Floats:
        shear, bulk = self.shear_modulus, self.bulk_modulus
        nu = 0.5 if self.incompressible else (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear)
        return isotropic_compliance(2.0 * shear * (1.0 + nu), nu)

    def with_ratio(self, nu: float) -> Self:
        """The same law with the compressibility of a Poisson's ratio at small strain."""
        given = "D" if hasattr(self, "D") else "D1"
        bulk = 2.0 * self.shear_modulus * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu))
        changed: dict[str, Any] = {given: 2.0 / bulk}
        return replace(self, **changed)

    def nominal(self, test: str, stretch: ArrayLike) -> Floats:
        """Nominal stress of a test of a sheet: force over the original area.

        Parameters
        ----------
        test : {"uniaxial", "biaxial", "planar"}
            Planar tension keeps the width of the sheet (pure shear).
        stretch : array_like, shape (n,)

        Returns
        -------
        ndarray, shape (n,)
            [force/length^2]
        """
        ratio = TESTS[test]
        axial = np.log(np.asarray(stretch, float))
        side = ratio * axial
        for _ in range(50):
            raw = self.respond(np.column_stack([axial, side, np.zeros_like(axial)]))
            if test != "uniaxial" or self.incompressible:
                break
            step = raw["stress"][:, 1] / raw["tangent"][:, 1, 1]
            side = side - np.clip(step, -0.5, 0.5)
            if np.abs(step).max(initial=0.0) < 1e-13:
                break
        return np.asarray(raw["stress"][:, 0] / np.exp(axial))

    def stability(self, low: float = 0.1, high: float = 10.0) -> dict[str, tuple[float, float]]:
        """Range of stretches about 1 in which the law is stable (Drucker), for each test.

        Parameters
        ----------
        low, high : float
            Range that is searched.

        Returns
        -------
        dict
            Smallest and largest stable stretch of uniaxial, biaxial and planar tests; those of the
            range itself where the law is stable up to there.
        """
        found = {}
        for test in TESTS:
            ends = []
            for end in (low, high):
                stretches = np.geomspace(1.0, end, 400)
                good = self._stable(test, stretches)
                first = int(np.argmin(good)) if not good.all() else len(good)
                ends.append(float(stretches[max(first - 1, 0)]))
            found[test] = (ends[0], ends[1])
        return found

    def _stable(self, test: str, stretch: Floats) -> Bools:
        axial = np.log(stretch)
        path = np.column_stack([axial, TESTS[test] * axial, np.zeros_like(axial)])
        tangent = self.respond(path)["tangent"][:, :2, :2]
        return np.asarray(np.linalg.eigvalsh(tangent)[:, 0] > 0.0)

    def plot_tests(self, ax: Any = None, **tests: ArrayLike) -> Any:
        """Draw nominal stress against stretch, with measured points.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
        **tests : array_like, shape (n, 2)
            ``uniaxial=``, ``biaxial=``, ``planar=``: rows of nominal stress and nominal strain.

        Returns
        -------
        matplotlib.axes.Axes
        """
        import matplotlib.pyplot as plt

        ax = ax or plt.figure().add_subplot()
        for color, test in enumerate(TESTS):
            data = np.asarray(tests.get(test, np.empty((0, 2))), float).reshape(-1, 2)
            if tests and not len(data):
                continue
            strain = data[:, 1] if len(data) else np.array([-0.3, 1.0])
            stretch = 1.0 + np.linspace(min(strain.min(), 0.0), max(strain.max(), 0.0), 100)
            ax.plot(stretch, self.nominal(test, stretch), color=f"C{color}", label=test)
            ax.plot(1.0 + data[:, 1], data[:, 0], "o", color=f"C{color}")
        ax.set_xlabel("stretch")
        ax.set_ylabel("nominal stress [force/length^2]")
        ax.legend()
        return ax


def laws_of_energies(kind: type[Hyperelastic] = Hyperelastic) -> list[str]:
    """Names of the laws that are an energy without memory, in the order of the core.

    ``Mullins`` and ``Viscoelastic`` give the core the place of their parent among them.
    """
    from corota import _core

    own = {kind.law} if hasattr(kind, "law") and not kind.remembers else set()
    own = own.union(*map(laws_of_energies, kind.__subclasses__()))
    return [name for name in _core.materials() if name in own]


def _rows(tests: dict[str, ArrayLike | None]) -> dict[str, Floats]:
    """Measured rows (stress, strain) by test, those at rest left out."""
    found = {}
    for test, given in tests.items():
        if given is None:
            continue
        rows = np.asarray(given, float)
        if rows.ndim != 2 or rows.shape[1] != 2 or not np.isfinite(rows).all():
            raise InputError(f"the {test} test data are rows of nominal stress and nominal strain")
        if (rows[:, 1] <= -1.0).any():
            raise InputError(f"a nominal strain of the {test} test data is -1 or less")
        found[test] = rows[(rows[:, 1] != 0.0) & (rows[:, 0] != 0.0)]
    if not any(len(rows) for rows in found.values()):
        raise InputError("a fit needs test data: uniaxial, biaxial or planar")
    return found


def _stresses(law: Hyperelastic, tests: dict[str, Floats]) -> Floats:
    """Nominal stress at all measured stretches, over the measured one."""
    return np.concatenate([law.nominal(t, 1.0 + r[:, 1]) / r[:, 0] for t, r in tests.items()])


def _warn_unstable(law: Hyperelastic, tests: dict[str, Floats]) -> None:
    """Warn where the fitted law loses stability between measured points."""
    import warnings

    for test, rows in tests.items():
        stretch = 1.0 + np.concatenate([np.linspace(0.0, e, 100) for e in rows[:, 1]])
        good = law._stable(test, stretch)
        if not good.all():
            bad = stretch[~good]
            first = bad[np.argmin(np.abs(np.log(bad)))]
            warnings.warn(
                f"the fitted {type(law).__name__} is unstable in the {test} test from the stretch "
                f"{first:.3g} on: take fewer terms or another law, or more tests",
                stacklevel=3,
            )


def _tests(uniaxial: Any, biaxial: Any, planar: Any) -> dict[str, Floats]:
    return _rows({"uniaxial": uniaxial, "biaxial": biaxial, "planar": planar})


@dataclass
class _OfInvariants(Hyperelastic, ABC):
    """A polynomial in the invariants of which a law has some coefficients."""

    law = "polynomial"
    #: Coefficients that a fit finds.
    fitted: ClassVar[tuple[str, ...]] = ()

    @property
    def incompressible(self) -> bool:
        return not any(self.parameters()[len(POWERS) :])

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """``C10, C01, C20, C11, C02, C30, C21, C12, C03, D1, D2, D3``; zero where there is none."""
        names = [f"C{i}{j}" for i, j in POWERS] + ["D1", "D2", "D3"]
        return [float(getattr(self, name, 0.0)) for name in names]

    @classmethod
    def fit(
        cls,
        uniaxial: ArrayLike | None = None,
        biaxial: ArrayLike | None = None,
        planar: ArrayLike | None = None,
        **others: Any,
    ) -> Self:
        """Fit the coefficients to tests of sheets at constant volume.

        Parameters
        ----------
        uniaxial, biaxial, planar : array_like, shape (n, 2), optional
            Rows of nominal stress and nominal strain; at least one test.
        **others
            Further parameters of the material (``D1``, ``rho``, ...).

        Returns
        -------
        Material
            With the smallest sum of squared relative errors of the stress, as in Abaqus. A
            warning names the stretch from which on it is unstable in a test.

        Raises
        ------
        InputError
            If there are no data, or none that give a positive shear modulus.
        """
        return cls._fit(_tests(uniaxial, biaxial, planar), cls.fitted, others)

    @classmethod
    def _fit(cls, tests: dict[str, Floats], names: Sequence[str], others: dict[str, Any]) -> Self:
        # Stress is linear in the coefficients: that of each is taken beside one neo-Hooke.
        base = _stresses(Polynomial(C10=1.0), tests)
        columns = [base]
        for name in names[1:]:
            one: dict[str, Any] = {"C10": 1.0, name: 1.0}
            law = Polynomial(**one)
            columns.append(_stresses(law, tests) - base)
        matrix = np.column_stack(columns)
        constants = np.linalg.lstsq(matrix, np.ones(len(matrix)), rcond=None)[0]
        named: dict[str, Any] = dict(zip(names, map(float, constants), strict=True))
        found = cls(**named, **others)
        _warn_unstable(found, tests)
        return found


@dataclass
class NeoHooke(_OfInvariants):
    """Rubber with one constant: ``W = C10 (I1 - 3) + (J - 1)^2 / D1``.

    Parameters
    ----------
    C10 : float
        Half of the shear modulus [force/length^2], > 0.
    D1 : float
        Two over the bulk modulus [length^2/force]; 0 for constant volume, in plane stress only.

    Raises
    ------
    InputError
        If the shear or bulk modulus is not positive.

    Notes
    -----
    Good up to stretches of about 1.5. ``I1`` is that of the isochoric deformation. As
    ``*HYPERELASTIC, NEO HOOKE`` of CalculiX and Abaqus. Source: R. S. Rivlin, *Phil. Trans. R.
    Soc. A* 240 (1948) 459-490.

    Examples
    --------
    >>> import corota as ct
    >>> rubber = ct.NeoHooke(C10=0.5, D1=0.002)
    >>> round(rubber.shear_modulus, 6), round(rubber.bulk_modulus, 6)
    (1.0, 1000.0)
    """

    C10: float
    D1: float = 0.0

    fitted = ("C10",)


@dataclass
class MooneyRivlin(_OfInvariants):
    """Rubber with two constants: ``W = C10 (I1 - 3) + C01 (I2 - 3) + (J - 1)^2 / D1``.

    Parameters
    ----------
    C10, C01 : float
        Coefficients [force/length^2]; the shear modulus is twice their sum.
    D1 : float
        Two over the bulk modulus [length^2/force]; 0 for constant volume, in plane stress only.

    Raises
    ------
    InputError
        If the shear or bulk modulus is not positive.

    Notes
    -----
    As ``*HYPERELASTIC, MOONEY-RIVLIN`` of CalculiX and Abaqus. Source: M. Mooney, *J. Appl. Phys.*
    11 (1940) 582-592.

    Examples
    --------
    >>> import corota as ct
    >>> rubber = ct.MooneyRivlin(C10=0.4, C01=0.1, D1=0.002)
    """

    C10: float
    C01: float
    D1: float = 0.0

    fitted = ("C10", "C01")


@dataclass
class Yeoh(_OfInvariants):
    """Rubber by a cubic in the first invariant, which stiffens at large stretch.

    ``W = C10 (I1 - 3) + C20 (I1 - 3)^2 + C30 (I1 - 3)^3 + sum (J - 1)^(2 i) / D_i``.

    Parameters
    ----------
    C10, C20, C30 : float
        Coefficients [force/length^2].
    D1, D2, D3 : float
        Compressibility [length^2/force]; all 0 for constant volume, in plane stress only.

    Raises
    ------
    InputError
        If the shear or bulk modulus is not positive.

    Notes
    -----
    One uniaxial test is enough for a fit that is sound in the other ones. As ``*HYPERELASTIC,
    YEOH`` of CalculiX and Abaqus. Source: O. H. Yeoh, *Rubber Chem. Technol.* 66 (1993) 754-771.

    Examples
    --------
    >>> import corota as ct
    >>> rubber = ct.Yeoh(C10=0.5, C20=-0.01, C30=0.001, D1=0.002)
    """

    C10: float
    C20: float = 0.0
    C30: float = 0.0
    D1: float = 0.0
    D2: float = 0.0
    D3: float = 0.0

    fitted = ("C10", "C20", "C30")


@dataclass
class Polynomial(_OfInvariants):
    """Rubber by a polynomial in the invariants, up to the third degree.

    ``W = sum C_ij (I1 - 3)^i (I2 - 3)^j + sum (J - 1)^(2 i) / D_i`` with the invariants of the
    isochoric deformation. The shear modulus at small strain is ``2 (C10 + C01)``, the bulk
    modulus ``2 / D1``.

    Parameters
    ----------
    C10, C01, C20, C11, C02, C30, C21, C12, C03 : float
        Coefficients [force/length^2].
    D1, D2, D3 : float
        Compressibility [length^2/force]; all 0 for constant volume, in plane stress only.

    Raises
    ------
    InputError
        If the shear or bulk modulus is not positive.

    Notes
    -----
    As ``*HYPERELASTIC, POLYNOMIAL`` of CalculiX and Abaqus; without the terms of ``I2`` it is the
    reduced polynomial. Source: R. S. Rivlin and D. W. Saunders, *Phil. Trans. R. Soc. A* 243 (1951)
    251-288.

    Examples
    --------
    >>> import corota as ct
    >>> rubber = ct.Polynomial(C10=0.4, C01=0.1, C20=0.01, D1=0.002)
    >>> round(rubber.shear_modulus, 6), round(rubber.bulk_modulus, 6)
    (1.0, 1000.0)
    """

    C10: float = 0.0
    C01: float = 0.0
    C20: float = 0.0
    C11: float = 0.0
    C02: float = 0.0
    C30: float = 0.0
    C21: float = 0.0
    C12: float = 0.0
    C03: float = 0.0
    D1: float = 0.0
    D2: float = 0.0
    D3: float = 0.0

    @classmethod
    def fit(
        cls,
        uniaxial: ArrayLike | None = None,
        biaxial: ArrayLike | None = None,
        planar: ArrayLike | None = None,
        *,
        terms: int = 1,
        reduced: bool = False,
        **others: Any,
    ) -> Self:
        """As :meth:`NeoHooke.fit`, up to a degree.

        Parameters
        ----------
        uniaxial, biaxial, planar : array_like, shape (n, 2), optional
            Rows of nominal stress and nominal strain; at least one test.
        terms : int
            Degree, 1 to 3.
        reduced : bool
            Without terms of the second invariant.
        **others
            Further parameters of the material (``D1``, ``rho``, ...).
        """
        if terms not in (1, 2, 3):
            raise InputError(f"a polynomial has 1 to 3 terms, not {terms}")
        names = [f"C{i}{j}" for i, j in POWERS if i + j <= terms and not (reduced and j)]
        return cls._fit(_tests(uniaxial, biaxial, planar), names, others)


@dataclass
class _OfStretches(Hyperelastic, ABC):
    """A law with a shear modulus and a power of the stretches for each term."""

    mu: float | Sequence[float]
    alpha: float | Sequence[float]

    def _columns(self, third: float | Sequence[float], name: str) -> list[float]:
        mu, alpha = (np.atleast_1d(np.asarray(v, float)) for v in (self.mu, self.alpha))
        last = np.atleast_1d(np.asarray(third, float))
        if not (mu.ndim == 1 and mu.shape == alpha.shape and len(last) in (1, len(mu))):
            raise InputError(f"mu, alpha and {name} need as many numbers as terms", self.where)
        if not 1 <= len(mu) <= MAX_TERMS:
            raise InputError(f"one to {MAX_TERMS} terms are possible, not {len(mu)}", self.where)
        return [
            float(v) for v in np.column_stack([mu, alpha, np.broadcast_to(last, mu.shape)]).flat
        ]

    @classmethod
    def _fit(
        cls, tests: dict[str, Floats], terms: int, make: Callable[[Floats, Floats], Self]
    ) -> Self:
        from scipy.optimize import least_squares

        if not 1 <= terms <= MAX_TERMS:
            raise InputError(f"one to {MAX_TERMS} terms are possible, not {terms}")
        size = np.mean([np.mean(rows[:, 0] / rows[:, 1]) for rows in tests.values()]) / 3.0

        def residual(x: Floats) -> Floats:
            try:
                return _stresses(make(size * x[:terms] ** 2, x[terms:]), tests) - 1.0
            except InputError:
                return np.full(sum(map(len, tests.values())), 1e3)

        best = None
        # The powers of rubbers that Ogden fitted, and their neighbors.
        for powers in ((1.3, 5.0, -2.0, 8.0, -4.0, 11.0), (2.0, -2.0, 4.0, -4.0, 7.0, -7.0)):
            signs = np.array(powers[:terms])
            start = np.concatenate([np.full(terms, terms**-0.5), signs])
            sides = np.tile([1e-3, 40.0], (terms, 1)) * np.sign(signs)[:, None]
            low = np.concatenate([np.zeros(terms), sides.min(axis=1)])
            high = np.concatenate([np.full(terms, 10.0), sides.max(axis=1)])
            found = least_squares(residual, start, bounds=(low, high), x_scale="jac")
            if best is None or found.cost < best.cost:
                best = found
        assert best is not None
        law = make(size * best.x[:terms] ** 2, best.x[terms:])
        _warn_unstable(law, tests)
        return law


@dataclass
class Ogden(_OfStretches):
    """Rubber by powers of the principal stretches.

    ``W = sum 2 mu_i / a_i^2 (l1^a_i + l2^a_i + l3^a_i - 3) + sum (J - 1)^(2 i) / D_i``, powers a_i,
    with the stretches of the isochoric deformation. The shear modulus at small strain is the sum
    of `mu`.

    Parameters
    ----------
    mu, alpha : float or sequence of float
        Shear modulus [force/length^2] and power of one to six terms.
    D : float or sequence of float
        Compressibility [length^2/force]; one number is ``D1``. All 0: constant volume, in plane
        stress only.

    Raises
    ------
    InputError
        If the numbers do not belong together, or the shear or bulk modulus is not positive.

    Notes
    -----
    As ``*HYPERELASTIC, OGDEN`` of CalculiX and Abaqus. Source: R. W. Ogden, *Proc. R. Soc. A* 326
    (1972) 565-584.

    Examples
    --------
    >>> import corota as ct
    >>> rubber = ct.Ogden(mu=(0.41, 0.003, 0.01), alpha=(1.3, 5.0, -2.0), D=0.002)
    """

    D: float | Sequence[float] = 0.0

    law = "ogden"

    @property
    def incompressible(self) -> bool:
        return not np.any(self.D)

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """``mu, alpha, D`` of each term."""
        D = np.zeros(max(np.size(self.mu), np.size(self.D)))
        D[: np.size(self.D)] = self.D
        return self._columns([float(v) for v in D], "D")

    @classmethod
    def fit(
        cls,
        uniaxial: ArrayLike | None = None,
        biaxial: ArrayLike | None = None,
        planar: ArrayLike | None = None,
        *,
        terms: int = 2,
        D: float | Sequence[float] = 0.0,
        **others: Any,
    ) -> Self:
        """As :meth:`NeoHooke.fit`, with moduli > 0 of one to six terms.

        Parameters
        ----------
        uniaxial, biaxial, planar : array_like, shape (n, 2), optional
            Rows of nominal stress and nominal strain; at least one test.
        terms : int
            Number of terms.
        D : float or sequence of float
            Compressibility of the material; the tests are taken at constant volume.
        **others
            Further parameters of the material (``rho``, ...).

        Examples
        --------
        >>> import numpy as np
        >>> import corota as ct
        >>> known = ct.Ogden(mu=0.7, alpha=2.5)
        >>> strain = np.linspace(0.1, 1.0, 10)
        >>> data = np.column_stack([known.nominal("uniaxial", 1 + strain), strain])
        >>> found = ct.Ogden.fit(uniaxial=data, terms=1)
        >>> round(found.mu[0], 6), round(found.alpha[0], 6)
        (0.7, 2.5)
        """

        def make(mu: Floats, alpha: Floats) -> Any:
            return cls(tuple(map(float, mu)), tuple(map(float, alpha)), **others)

        found = cls._fit(_tests(uniaxial, biaxial, planar), terms, make)
        return replace(found, D=D)


@dataclass
class Hyperfoam(_OfStretches):
    """Foam by powers of the principal stretches, strongly compressible.

    ``W = sum 2 mu_i / alpha_i^2 (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3 + (J^(-alpha_i beta_i) -
    1) / beta_i)`` with ``beta = nu / (1 - 2 nu)``. The shear modulus at small strain is the sum of
    `mu`.

    Parameters
    ----------
    mu, alpha : float or sequence of float
        Shear modulus [force/length^2] and power of one to six terms.
    nu : float or sequence of float
        Poisson's ratio of all or of each, -1 < nu < 1/2.

    Raises
    ------
    InputError
        If the numbers do not belong together, or the shear or bulk modulus is not positive.

    Notes
    -----
    As ``*HYPERFOAM`` of CalculiX and Abaqus. Source: B. Storakers, *J. Mech. Phys. Solids* 34
    (1986) 125-145.

    Examples
    --------
    >>> import corota as ct
    >>> foam = ct.Hyperfoam(mu=0.1, alpha=8.0, nu=0.0)
    """

    nu: float | Sequence[float] = 0.0

    law = "hyperfoam"

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """``mu, alpha, nu`` of each term."""
        return self._columns(self.nu, "nu")

    @classmethod
    def fit(
        cls,
        uniaxial: ArrayLike | None = None,
        biaxial: ArrayLike | None = None,
        planar: ArrayLike | None = None,
        *,
        terms: int = 1,
        nu: float = 0.0,
        **others: Any,
    ) -> Self:
        """As :meth:`Ogden.fit`, with a known Poisson's ratio of all terms."""

        def make(mu: Floats, alpha: Floats) -> Any:
            return cls(tuple(map(float, mu)), tuple(map(float, alpha)), nu, **others)

        return cls._fit(_tests(uniaxial, biaxial, planar), terms, make)


@dataclass
class ArrudaBoyce(Hyperelastic):
    """Rubber as a network of eight chains, which lock at a limit stretch.

    ``W = mu sum C_i / limit^(2 i - 2) (I1^i - 3^i) + ((J^2 - 1) / 2 - ln J) / D`` with the five
    terms C = 1/2, 1/20, 11/1050, 19/7000, 519/673750 of the inverse Langevin function.

    Parameters
    ----------
    mu : float
        Modulus [force/length^2]; the shear modulus at small strain is a little larger.
    limit : float
        Stretch at which the chains lock, > 0.
    D : float
        Two over the bulk modulus [length^2/force]; 0 for constant volume, in plane stress only.

    Raises
    ------
    InputError
        If a number is outside its range.

    Notes
    -----
    As ``*HYPERELASTIC, ARRUDA-BOYCE`` of CalculiX and Abaqus. Source: E. M. Arruda and M. C. Boyce,
    *J. Mech. Phys. Solids* 41 (1993) 389-412.

    Examples
    --------
    >>> import corota as ct
    >>> rubber = ct.ArrudaBoyce(mu=1.0, limit=4.0, D=0.002)
    """

    mu: float
    limit: float
    D: float = 0.0

    law = "arruda_boyce"

    @property
    def incompressible(self) -> bool:
        return self.D == 0.0

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """``mu, limit, D``."""
        return [float(self.mu), float(self.limit), float(self.D)]

    @classmethod
    def fit(
        cls,
        uniaxial: ArrayLike | None = None,
        biaxial: ArrayLike | None = None,
        planar: ArrayLike | None = None,
        *,
        D: float = 0.0,
        **others: Any,
    ) -> Self:
        """As :meth:`NeoHooke.fit`."""
        from scipy.optimize import minimize_scalar

        tests = _tests(uniaxial, biaxial, planar)

        def modulus(x: float) -> tuple[float, float]:
            """Best modulus at a logarithm of the limit, and the error."""
            shape = _stresses(cls(1.0, math.exp(x)), tests)
            mu = float(shape.sum() / (shape @ shape))
            return mu, float(((mu * shape - 1.0) ** 2).sum())

        grid = np.linspace(math.log(1.05), math.log(50.0), 60)
        nearest = grid[int(np.argmin([modulus(x)[1] for x in grid]))]
        step = grid[1] - grid[0]
        best = minimize_scalar(
            lambda x: modulus(x)[1],
            bounds=(nearest - step, nearest + step),
            method="bounded",
            options={"xatol": 1e-10},
        )
        found = cls(modulus(best.x)[0], math.exp(best.x), D, **others)
        _warn_unstable(found, tests)
        return found


def with_ratio(material: Any, nu: float) -> Any:
    """A law with the compressibility of a Poisson's ratio, or one with such a parent."""
    if hasattr(material, "parent"):
        return replace(material, parent=with_ratio(material.parent, nu))
    return material.with_ratio(nu)
