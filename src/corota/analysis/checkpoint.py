"""A checkpoint: the whole state of an analysis after an increment, for bitwise identical resume."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Protocol

import numpy as np

from corota.analysis.state_tree import Reader, Tree, Writer, digest_of
from corota.errors import UnsupportedError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from corota.analysis.equations import System
    from corota.analysis.parallel.communicator import Communicator
    from corota.analysis.state import State
    from corota.analysis.terms.moving_mass import MovingMass
    from corota.model.model import Model
    from corota.model.steps import Step


@dataclass
class Checkpoint:
    """State after an increment.

    Parameters
    ----------
    step, increment : int
        The increment, from 1.
    time, step_time, factor : float
        Of its end.
    kind : str
        Loop that it was taken in: static, path, dynamic or explicit.
    tree : dict
        See :mod:`corota.analysis.state_tree`.
    arrays : list of ndarray
        Numbers of the tree.
    leave_step : bool
        Whether a run that starts here leaves the rest of the step out.
    processes : list of int
        With several processes `tree` holds one tree for each; the first array of each.
    """

    step: int
    increment: int
    time: float
    step_time: float
    factor: float
    kind: str
    tree: Tree
    arrays: list[NDArray[np.generic]]
    leave_step: bool = False
    processes: list[int] = field(default_factory=list)

    @property
    def where(self) -> str:
        """The increment in words."""
        return f"step {self.step}, increment {self.increment}, time {self.time:.6g}"

    def part(self, communicator: Communicator) -> Checkpoint:
        """The state of one process.

        Raises
        ------
        UnsupportedError
            If it was taken by another number of processes.
        """
        count = max(len(self.processes), 1)
        if count != communicator.size:
            raise UnsupportedError(
                f"the checkpoint has the states of {count} processes, and there are "
                f"{communicator.size}: continue with as many as have written it"
                + (f" (mpiexec -n {count}, solver 'petsc')" if count > 1 else "")
            )
        if count == 1:
            return self
        first = self.processes[communicator.rank]
        own = self.tree["processes"][communicator.rank]
        return replace(self, tree=own, arrays=self.arrays[first:], processes=[])


@dataclass
class Begun:
    """Data at the start of a step that are not part of the state of an increment.

    Parameters
    ----------
    time : float
        Total time at the start of the step [time].
    first : bool
        Whether nothing was loaded before.
    ended : float
        Step time at which the loads of the step before ended [time].
    """

    time: float
    first: bool
    ended: float


class Analysis(Protocol):
    """Interface of a run for checkpoints."""

    system: System
    steps: list[Step]
    warned: set[str]
    begun: list[Begun]
    as_built: Mapping[str, object]
    communicator: Communicator

    def known(self) -> dict[str, object]:
        """Objects stored by reference in checkpoints."""

    def mass(self, number: int) -> MovingMass:
        """Mass that gravity acts on in a step."""


@dataclass
class Resumption:
    """A checkpoint and the analysis that it restores."""

    analysis: Analysis
    checkpoint: Checkpoint
    built: Mapping[str, NDArray[np.generic]]
    known: dict[str, object] = field(init=False)

    def __post_init__(self) -> None:
        self.known = self.analysis.known()

    @property
    def kind(self) -> str:
        """Kind of the loop."""
        return self.checkpoint.kind

    def restore(self, state: State) -> None:
        """Restore the state of all objects of the analysis."""
        Reader(self.checkpoint.arrays, self.known, self.built).read(
            self.checkpoint.tree, root(self.analysis, state)
        )


def root(analysis: Analysis, state: State) -> dict[str, object]:
    """What a checkpoint holds."""
    return {
        "system": analysis.system,
        "state": state,
        "warned": analysis.warned,
        "begun": analysis.begun,
    }


def take(analysis: Analysis, state: State, where: tuple[int, int], factor: float) -> Checkpoint:
    """The state as it is now, in copies."""
    assert state.loop is not None
    writer = Writer(analysis.known(), analysis.as_built)
    tree, arrays = writer.write(root(analysis, state), ""), writer.arrays
    processes: list[int] = []
    if analysis.communicator.size > 1:
        parts = analysis.communicator.gather((tree, arrays))
        tree, arrays = {"processes": [own for own, _ in parts]}, []
        for _, own in parts:
            processes.append(len(arrays))
            arrays += own
    return Checkpoint(
        *where,
        state.time + state.step_time,
        state.step_time,
        factor,
        state.loop["kind"],
        tree,
        arrays,
        processes=processes,
    )


def model_tree(model: Model, steps: list[Step]) -> tuple[Tree, list[NDArray[np.generic]], str]:
    """A model and its steps by value: tree, arrays and digest.

    Raises
    ------
    Unstorable
        If it holds functions, as user materials do.
    """
    writer = Writer({}, by_value=True)
    tree = writer.write({"model": model, "steps": steps}, "")
    return tree, writer.arrays, digest_of(tree, writer.arrays)


def replay(analysis: Analysis, begun: list[Begun]) -> None:
    """Begin the steps of a checkpoint again to rebuild the load objects.

    Their numbers follow with the rest of the state.
    """
    system = analysis.system
    zero = np.zeros(system.n_dofs)
    for number, start in enumerate(begun, start=1):
        step = analysis.steps[number - 1]
        system.mass = analysis.mass(number)
        system.conditions.end_time = start.ended
        system.begin(step, start.time, zero.copy(), None if start.first else zero)
