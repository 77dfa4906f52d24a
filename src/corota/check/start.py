"""Whether a run starts, by its own first increment."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

from corota.errors import ConvergenceError, CorotaError
from corota.results.observer import BaseObserver, Iteration

if TYPE_CHECKING:
    from corota.model.model import Model
    from corota.model.steps import Step
    from corota.results.results import Frame


class _Begun(Exception):
    """The run is under way."""


class _Watch(BaseObserver):
    """Ends a run as soon as it has started.

    Without contact one solution of the tangent is enough. With contact bodies may separate and be
    unconstrained until the first increment is accepted.
    """

    def __init__(self, contact: bool) -> None:
        self.contact = contact

    def step(self, number: int, step: Step) -> None:
        """Stop at the second step."""
        if number > 1:
            raise _Begun

    def iteration(self, info: Iteration) -> None:
        """Stop after a solution."""
        if not self.contact:
            raise _Begun

    def increment(self, frame: Frame) -> None:
        """Stop after an increment."""
        if frame.increment > 0:
            raise _Begun


def refusal(model: Model) -> CorotaError | None:
    """Why a run of the model's steps would not start; None if it would.

    The system is that of the run, with constraints, ties and contact.

    Parameters
    ----------
    model : Model
        With steps.
    """
    from corota.analysis.run import solve

    watch = _Watch(bool(model.contacts or model.ties))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            solve(model, observers=[watch], fields=False, keep="last")
        except (_Begun, ConvergenceError):
            return None
        except CorotaError as error:
            return error
    return None
