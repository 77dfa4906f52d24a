"""Materials written in Python: one function over all points of a block at a time."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.model.materials import Material

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from corota.arrays import Floats
    from corota.model.local_strain import LocalStrain


@dataclass
class UserMaterial(Material):
    """A material given by a Python function.

    Parameters
    ----------
    function : callable
        ``function(strain, state, plane) -> (stress, tangent, state)``, optionally with a fourth
        item, a dict. `strain` is (n, p, 3) for n elements with p points, rows xx, yy, xy with
        engineering shear, in the axes of the element frames; `state` is the committed history
        (n, p, members) and must not be changed; `plane` is ``"stress"`` or ``"strain"``. The
        result is stress (n, p, 3), tangent (n, p, 3, 3) and the new history. The dict may have
        ``strain_zz``, ``stress_zz``, ``energy`` and ``PEEQ``, each (n, p), for output.
    members : int
        Number of history variables per point.
    initial : array_like, shape (members,), optional
        History at the start; zeros by default.

    Notes
    -----
    The tangent is the derivative of the new stress by the strain; its symmetric part is used.
    The function is called once for each evaluation of the model (a few times for elements
    with internal modes), so that its cost is that of numpy on whole arrays.

    Examples
    --------
    >>> import numpy as np
    >>> import corota as ct
    >>> c = np.array([[1000.0, 0.0, 0.0], [0.0, 1000.0, 0.0], [0.0, 0.0, 500.0]])
    >>> def spring(strain, state, plane):
    ...     return strain @ c, np.broadcast_to(c, (*strain.shape, 3)), state
    >>> material = ct.UserMaterial(spring)
    >>> model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    >>> model.section("all", element="Q4", material=material)
    >>> model.fix("left", y=None)
    >>> model.fix("bottom", x=None)
    >>> model.fix("right", x=0.02, y=None)
    >>> results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    >>> float(results.frames[-1].fields[0].values["S"][0, 0, 0].round(6))
    10.0
    """

    function: Callable[..., Any]
    members: int = 0
    initial: ArrayLike | None = None

    law = "given"
    for_rings = False

    def __post_init__(self) -> None:
        if not callable(self.function):
            raise InputError("function must be callable", self.where)
        if self.members < 0:
            raise InputError(f"members must be >= 0, not {self.members}", self.where)
        if self.initial is not None and np.shape(self.initial) != (self.members,):
            raise InputError(
                f"initial must have {self.members} numbers, not shape {np.shape(self.initial)}",
                self.where,
            )
        self._check_motion()

    @property
    def default_strain(self) -> LocalStrain:
        return "logarithmic" if self.members else "linear"

    def start(self, n: int, p: int) -> Floats:
        """History of n elements with p points at the start, shape (n, p, members)."""
        first = np.zeros(self.members) if self.initial is None else np.asarray(self.initial, float)
        return np.tile(first, (n, p, 1))

    def parameters(self, orientation: float = 0.0) -> list[float]:
        """The tangent at rest, 9 numbers by rows."""
        _, tangent, _, _ = self.call(np.zeros((1, 1, 3)), self.start(1, 1), "stress")
        return [float(v) for v in tangent.ravel()]

    def call(
        self, strain: Floats, state: Floats, plane: str
    ) -> tuple[Floats, Floats, Floats, dict[str, Floats]]:
        """Call the function and check what it returns.

        Raises
        ------
        InputError
            If a shape is wrong or the function wrote into its input.
        """
        given = state.copy()
        answer = self.function(strain.copy(), state, plane)
        if not (isinstance(answer, tuple) and len(answer) in (3, 4)):
            raise InputError(
                "the material function must return (stress, tangent, state) or "
                "(stress, tangent, state, dict)",
                self.where,
            )
        stress, tangent, new = (np.asarray(v, float) for v in answer[:3])
        extra = dict(answer[3]) if len(answer) == 4 else {}
        wanted = strain.shape, (*strain.shape, 3), state.shape
        for name, array, shape in zip(
            ("stress", "tangent", "state"), (stress, tangent, new), wanted, strict=True
        ):
            if array.shape != shape:
                raise InputError(
                    f"the material function returned {name} of shape {array.shape}, "
                    f"expected {shape}",
                    self.where,
                )
        if not np.array_equal(given, state, equal_nan=True):
            raise InputError(
                "the material function changed the history that it was given; return a new array",
                self.where,
            )
        return stress, tangent, new, extra

    def respond(self, strain: ArrayLike, plane: str = "stress") -> dict[str, Floats]:
        """Response of a single point to a strain path, as of :meth:`corota.Mises.respond`."""
        path = np.atleast_2d(np.asarray(strain, float))
        state = self.start(1, 1)
        stress, tangent, extras = [], [], []
        for row in path:
            s, d, state, extra = self.call(row.reshape(1, 1, 3), state, plane)
            stress.append(s[0, 0])
            tangent.append(d[0, 0])
            extras.append(extra)
        out = {"stress": np.array(stress), "tangent": np.array(tangent)}
        for name in extras[0] if extras else ():
            out[name] = np.array([np.asarray(e[name]).item() for e in extras])
        return out
