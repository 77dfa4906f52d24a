"""Commands that several processes carry out together: one of them prints and writes files."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import contextlib
import os
from typing import TYPE_CHECKING, Any

from corota.analysis.parallel.communicator import ALONE, Communicator
from corota.errors import UnsupportedError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from corota.cli.terminal import Terminal

#: Variables by which starters of MPI programs tell how many processes they started, and which
#: one this is.
COUNTS = ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE")
RANKS = ("OMPI_COMM_WORLD_RANK", "PMI_RANK")


@contextlib.contextmanager
def together(args: Any, terminal: Terminal) -> Iterator[Communicator]:
    """The processes that carry out a command; an error of one ends them all.

    Raises
    ------
    UnsupportedError
        If there are several and the solver runs on one.
    """
    if _number(RANKS) > 0:
        terminal.mute()
    communicator = _communicator(args)
    try:
        yield communicator
    except BaseException as error:
        communicator.leave(error, getattr(error, "exit_code", 70))
        raise


def _communicator(args: Any) -> Communicator:
    count = _number(COUNTS)
    if count <= 1:
        return ALONE
    if not getattr(args, "solver", "").startswith("petsc"):
        raise UnsupportedError(
            f"mpiexec started {count} processes, and this solver runs on one: add --solver petsc "
            "to run them on one model, start the run without mpiexec, or run many variants by "
            "corota sweep"
        )
    from corota.analysis.linear.petsc import load_petsc
    from corota.analysis.parallel.mpi import processes

    load_petsc()
    return processes()


def _number(names: Sequence[str]) -> int:
    """Largest number that one of these variables has, 0 without."""
    found = [os.environ.get(name, "") for name in names]
    return max((int(text) for text in found if text.isdigit()), default=0)
