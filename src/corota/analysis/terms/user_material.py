"""Blocks whose material is a Python function: strains out, stress and tangent in."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from corota.analysis.failure import ElementFailure
from corota.model import elements
from corota.model.user_material import UserMaterial

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import corota._core as _core
    from corota.arrays import Floats
    from corota.model.blocks import BlockOfCells


#: Change of the strain, relative to the largest, below which the linear part is exact.
SETTLED = 1e-9
#: Rounding errors of strain under a rigid motion.
ROUNDING = 1e-13
#: Calls for one evaluation of elements with internal modes.
MAX_CALLS = 30


#: Message where the function of a material returns NaN or infinity.
NO_NUMBER = "the material function returned a stress or tangent that is not a number"


#: By plane: what a function may return of the normal direction, its output, and what needs it.
_ACROSS = {
    "stress": ("strain_zz", "strain E33", ""),
    "strain": ("stress_zz", "stress S33", ", also in MISES and pressure"),
}


@dataclass
class _Block:
    index: int
    material: UserMaterial
    plane: str
    shape: tuple[int, int]
    modes: bool
    committed: Floats
    trial: Floats = field(init=False)
    # Strain and stress of both, and the work done so far by volume.
    point: Floats | None = None
    point_trial: Floats | None = None
    work: Floats | float = 0.0
    given: Floats = field(init=False)  # values of the core, and the same with their own tangents
    own: Floats = field(init=False)
    stores: bool = False  # whether the function gives the recoverable energy
    # Equivalent plastic strain, where the function gives one.
    plastic: Floats | float = 0.0
    plastic_trial: Floats | float = 0.0
    #: What the function gives of the direction normal to the plane; None before a call.
    across: set[str] | None = None

    def __post_init__(self) -> None:
        self.trial = self.committed


class UserBlocks:
    """The blocks of a model with materials in Python."""

    def __init__(self, core: _core.Problem, blocks: Sequence[BlockOfCells]) -> None:
        self.core = core
        # Largest strain so far: a body may return to its shape.
        self.largest = 0.0
        self.blocks = []
        for index, block in enumerate(blocks):
            material = block.section.material
            if isinstance(material, UserMaterial):
                fact = elements.find(block.section.element)
                shape = (len(block.cells), fact.n_points)
                self.blocks.append(
                    _Block(
                        index,
                        material,
                        block.section.plane,
                        shape,
                        fact.n_internal_modes > 0,
                        material.start(*shape),
                    )
                )

    @property
    def notes(self) -> list[str]:
        """What functions leave out of the direction normal to the plane, once for each law."""
        found = {}
        for block in self.blocks:
            name, zero, also = _ACROSS[block.plane]
            if block.across is not None and name not in block.across:
                called = getattr(block.material.function, "__name__", "the function")
                found[called, name] = (
                    f"material function {called!r} returns no {name} in plane {block.plane}: "
                    f"{zero} is shown as 0{also}; return it in a dict as fourth item"
                )
        return list(found.values())

    def assemble(
        self, u: Floats, nlgeom: bool, assemble: Callable[[], None], between: bool = False
    ) -> None:
        """Assemble with the functions' answers at the strains of `u`.

        Elements with internal modes solve for them with the linear part of the result; that is
        repeated until the strains converge. With `between` the elements also need the stress of
        the committed state, which the linear part then gives too.

        Raises
        ------
        ElementFailure
            If the internal modes do not converge.
        """
        if not self.blocks:
            assemble()
            return
        assemble_once = not any(b.modes for b in self.blocks)
        seen = [self._strain(b, u, nlgeom, True) for b in self.blocks]
        for _ in range(MAX_CALLS):
            for block, strain in zip(self.blocks, seen, strict=True):
                self._give(block, strain, between)
            assemble()
            if assemble_once:
                return
            now = [self._strain(b, u, nlgeom, False) for b in self.blocks]
            size = max(float(np.abs(e).max(initial=0.0)) for e in now)
            change = max(
                float(np.abs(a - b).max(initial=0.0)) for a, b in zip(now, seen, strict=True)
            )
            self.largest = max(self.largest, size)
            if change <= max(SETTLED * self.largest, ROUNDING):
                return
            seen = now
        raise ElementFailure(
            "the internal modes of elements with a Python material did not converge"
            + ("; use Q4, Q8 or OPT there, or another scheme" if between else "")
        )

    def _strain(self, block: _Block, u: Floats, nlgeom: bool, committed: bool) -> Floats:
        flat: Floats = self.core.strains(block.index, u, nlgeom, committed)
        return flat.reshape(*block.shape, 3)

    def _give(self, block: _Block, strain: Floats, between: bool) -> None:
        stress, tangent, block.trial, extra = block.material.call(
            strain, block.committed, block.plane
        )
        right = np.isfinite(stress).all(axis=(1, 2)) & np.isfinite(tangent).all(axis=(1, 2, 3))
        if not right.all():
            # In the format of the core for failed elements: a shorter increment may converge.
            wrong = [(block.index, int(e)) for e in np.flatnonzero(~right)]
            raise RuntimeError(NO_NUMBER, wrong)
        values = np.zeros((*block.shape, 16))
        values[..., :3], values[..., 3:6] = strain, stress
        symmetric = 0.5 * (tangent + np.swapaxes(tangent, -1, -2))
        rows, columns = np.triu_indices(3)
        values[..., 6:12] = symmetric[..., rows, columns]
        block.across = extra.keys() & {"strain_zz", "stress_zz"}
        for member, name in enumerate(("strain_zz", "stress_zz", "energy", "PEEQ"), start=12):
            if name in extra:
                values[..., member] = extra[name]
        block.plastic_trial = values[..., 15]
        block.stores = "energy" in extra
        block.point_trial = values[..., :6].copy()
        if between:
            # From the committed state on, so that its stress is exact.
            old = np.zeros((*block.shape, 6)) if block.point is None else block.point
            values[..., :6] = old
            block.own = values.copy()
            secant = _through(symmetric, strain - old[..., :3], stress - old[..., 3:])
            values[..., 6:12] = secant[..., rows, columns]
        block.given = values
        self.core.give(block.index, values.ravel())

    def linearize(self, assemble: Callable[[], None], tangent: Floats) -> None:
        """After an assembly `between`: fill in `tangent` with the functions' own tangents."""
        for block in self.blocks:
            self.core.give(block.index, block.own.ravel())
        assemble()
        kept = tangent.copy()
        for block in self.blocks:
            self.core.give(block.index, block.given.ravel())
        assemble()
        tangent[:] = kept

    def commit(self) -> None:
        """Accept the last answers."""
        for block in self.blocks:
            block.committed = block.trial
            block.plastic = block.plastic_trial
            new = block.point_trial
            if new is not None:
                old = np.zeros_like(new) if block.point is None else block.point
                mean = 0.5 * (old[..., 3:] + new[..., 3:])
                block.work = block.work + np.einsum(
                    "epr,epr->ep", mean, new[..., :3] - old[..., :3]
                )
                block.point = new

    def energies(self, index: int, stored: Floats, volume: Floats) -> tuple[float, float]:
        """Energy of a block in addition to that of its function, and its dissipation.

        A function without energies stores all the work that is done on it.

        Parameters
        ----------
        index : int
            Block.
        stored : ndarray, shape (n, p)
            Recoverable energy by volume that the function gave.
        volume : ndarray, shape (n, p)
        """
        for block in self.blocks:
            if block.index == index:
                rest = float(np.sum((block.work - stored) * volume))
                return (0.0, rest) if block.stores else (rest, 0.0)
        return 0.0, 0.0

    def plastic_increment(self) -> float:
        """Largest growth of the equivalent plastic strain since the last commit."""
        return max((float(np.max(b.plastic_trial - b.plastic)) for b in self.blocks), default=0.0)


def _through(tangent: Floats, strain: Floats, stress: Floats) -> Floats:
    """The symmetric tangents next to `tangent` that map `strain` to `stress` (Powell 1970).

    Parameters
    ----------
    tangent : ndarray, shape (n, p, 3, 3)
    strain, stress : ndarray, shape (n, p, 3)
    """
    square = np.einsum("epr,epr->ep", strain, strain)
    moves = square > ROUNDING**2 * 1e-8
    s = strain / np.sqrt(np.where(moves, square, 1.0))[..., None]
    rest = stress / np.sqrt(np.where(moves, square, 1.0))[..., None]
    rest = np.where(moves[..., None], rest - np.einsum("eprs,eps->epr", tangent, s), 0.0)
    along = np.einsum("epr,epr->ep", rest, s)[..., None, None]
    cross = rest[..., :, None] * s[..., None, :]
    twice = along * s[..., :, None] * s[..., None, :]
    out: Floats = tangent + cross + np.swapaxes(cross, -1, -2) - twice
    return out
