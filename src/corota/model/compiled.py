"""Materials given by compiled functions: the C interface of the package, and Abaqus's UMAT."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import ctypes
import math
from copy import copy
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from corota.errors import FileError, InputError, number
from corota.model.single_point import SinglePoint
from corota.names import choose_attribute

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Sequence


#: Names under which compilers export a subroutine UMAT.
SYMBOLS = ("umat_", "umat", "UMAT", "_umat_")
#: Characters of ``CMNAME``.
NAME_LENGTH = 80


class _Compiled(SinglePoint):
    """Common part of materials whose function has an address."""

    #: Gives the handle of the function. A function, which checkpoints can neither store nor name.
    _handle: Callable[[], int]

    constants: Sequence[float]
    states: int

    depends_on_time = True

    def __deepcopy__(self, memo: dict[int, Any]) -> _Compiled:
        return copy(self)

    def _check(self) -> None:
        if not (isinstance(self.states, int) and self.states >= 0):
            raise InputError(f"states must be a whole number >= 0, not {self.states!r}", self.where)
        for value in self.constants:
            number(value, "a constant")
        self._check_motion()

    def _register(self, address: int) -> None:
        from corota import _core

        handle = _core.register_function(self.law, address)
        self._handle = lambda: handle

    def _known_handle(self) -> float:
        handle = getattr(self, "_handle", None)
        if not callable(handle):
            raise InputError(
                "the compiled function of this material is not part of a checkpoint: give the "
                "model again, corota.resume(path, model=...)",
                self.where,
            )
        return float(handle())


@dataclass(repr=False)
class CompiledMaterial(_Compiled):
    """A material given by a compiled function with the C interface of the package.

    Parameters
    ----------
    function : int, ctypes function or object with an ``address``
        Such as the address of a function in a library, or a ``numba.cfunc``.
    constants : sequence of float
        Numbers that the function is given.
    states : int
        Number of history variables per point, which begin at zero.

    Notes
    -----
    ``int32 f(int64 n, int64 plane, double *constants, double *time, double *strain, double *old,
    double *new, double *stress, double *tangent, double *extra)`` is called for some points at a
    time, on several threads. `plane` is 0 for plane stress, 1 for plane strain; `time` is the
    increment and the total time at its end; `strain` is (n, 3), rows xx, yy, xy with engineering
    shear, in axes that turn with the body; `old` and `new` are (n, states), `stress` (n, 3),
    `tangent` (n, 3, 3), `extra` (n, 5): strain and stress through the thickness, energy, dissipated
    work and equivalent plastic strain, all zero at the start; where the energy stays zero, what is
    not dissipated is stored. It returns 0, or another number if it has no answer, which shortens
    the increment. Elements take the symmetric part of the tangent. A function that breaks these
    rules can end the process: try it with ``corota check-material`` first.

    Examples
    --------
    ``ct.CompiledMaterial(law.address)`` with a function `law` decorated by
    ``@numba.cfunc(...)``: see the how-to page of compiled laws.
    """

    function: Any
    constants: Sequence[float] = ()
    states: int = 0

    law = "c_function"
    for_rings = False

    def __post_init__(self) -> None:
        self._check()
        self._register(_address(self.function, self.where))

    @property
    def default_strain(self) -> Literal["logarithmic", "linear"]:
        return "logarithmic" if self.states else "linear"

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """Handle, members, constants."""
        return [self._known_handle(), float(self.states), *(float(v) for v in self.constants)]


@dataclass(repr=False)
class Umat(_Compiled):
    """A material given by an Abaqus user subroutine UMAT in a shared library.

    Parameters
    ----------
    library : path-like
        The library, such as ``gfortran -shared -fPIC -O2 -o law.so law.f`` makes. Its code runs
        with the rights of the program.
    constants : sequence of float
        ``PROPS``.
    states : int
        ``NSTATV``, as of ``*DEPVAR``; zero at the start.
    terms : {"strain", "gradient"}
        Whether the subroutine is in terms of ``STRAN`` and ``DSTRAN``, with ``DDSDDE`` the
        derivative of ``STRESS`` by ``DSTRAN``, or of ``DFGRD1``, with ``DDSDDE`` that of the
        Kirchhoff stress in the rate of Jaumann over the volume, with the tangent exact at large
        strain. Forces do not depend on this.
    thickness_ratio : float
        Poisson's ratio by which the thickness follows the strain in plane stress, where ``NDI`` is
        2; 1/2 keeps the volume, as in Abaqus's sections.

    Raises
    ------
    FileError
        If the library cannot be loaded.
    InputError
        If it has no UMAT, or a number is wrong.

    Notes
    -----
    ``STRESS`` is Cauchy stress, ``STRAN`` logarithmic strain, in the frame of the element, which
    turns with the body: ``DROT`` is the unit matrix, ``DFGRD0`` and ``DFGRD1`` are stretches
    without rotation. In small displacements, and under another local strain, the volume does not
    change. ``CMNAME`` is the name of the material in capitals. ``TIME`` is the total time twice;
    ``NOEL``, ``NPT``, ``KSTEP`` and ``KINC`` are 1; ``COORDS``, ``TEMP``, ``CELENT`` and predefined
    fields are 0. ``PNEWDT`` below 1 shortens the increment. ``SSE`` is the recoverable energy,
    ``SPD`` and ``SCD`` are dissipated; where ``SSE`` stays zero, what is not dissipated is stored.
    Utility routines of Abaqus (``XIT``, ``SPRINC`` and so on) must be part of the library. Points
    are evaluated on several threads: with ``COMMON`` blocks or ``SAVE`` take ``threads=1``.
    """

    library: str | os.PathLike[str]
    constants: Sequence[float] = ()
    states: int = 0
    terms: Literal["strain", "gradient"] = "strain"
    thickness_ratio: float = 0.5

    law = "umat"
    flows = True

    def __post_init__(self) -> None:
        choose_attribute(self, "terms", ("strain", "gradient"), "terms", self.where)
        if not -1.0 < number(self.thickness_ratio, "thickness_ratio") <= 0.5:
            raise InputError(
                f"thickness_ratio must be above -1 and at most 0.5, not {self.thickness_ratio:g}",
                self.where,
            )
        self._check()
        self._register(find_umat(self.library))

    @property
    def small_at_points(self) -> bool:
        """In terms of the strain ``respond`` gives ``STRESS`` and ``DDSDDE`` themselves."""
        return self.terms == "strain"

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """Handle, states, terms, ratio of the thickness, name, constants."""
        name = self.name.upper()[:NAME_LENGTH].encode("ascii", "replace")
        head = [self._known_handle(), float(self.states), float(self.terms == "gradient")]
        head += [self.thickness_ratio, float(len(name)), *(float(c) for c in name)]
        return [*head, *(float(v) for v in self.constants)]


def find_umat(library: str | os.PathLike[str]) -> int:
    """Load a library and give the address of its UMAT.

    Raises
    ------
    FileError
        If the library cannot be loaded.
    InputError
        If it has no UMAT.
    """
    path = Path(library).resolve()
    if not path.is_file():
        raise FileError(f"{library}: no such library")
    try:
        loaded = ctypes.CDLL(str(path))
    except OSError as error:
        raise FileError(f"{library}: it cannot be loaded: {error}") from None
    for symbol in SYMBOLS:
        try:
            return _address(getattr(loaded, symbol), None)
        except AttributeError:
            continue
    raise InputError(
        f"{library}: it has no subroutine UMAT (no symbol {', '.join(SYMBOLS)}); gfortran -shared "
        "-fPIC exports one that is in no module"
    )


#: Functions of libraries.
_FUNCTION: Any = type(ctypes.pythonapi.PyLong_AsLong).__mro__[1]
#: Objects whose functions are called: they must outlive the models.
_ALIVE: list[Any] = []


def _address(function: Any, where: Any) -> int:
    """Address of an integer, a ctypes function or an object with an ``address``."""
    _ALIVE.append(function)
    if isinstance(function, _FUNCTION):
        found = ctypes.cast(function, ctypes.c_void_p).value
    else:
        found = getattr(function, "address", function)
    if isinstance(found, bool) or not isinstance(found, int) or not 0 < found < math.inf:
        raise InputError(
            f"function must be an address, a ctypes function or have an address, not {function!r}",
            where,
        )
    return found
