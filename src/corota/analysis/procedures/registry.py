"""The one list of procedures: what a step of each kind runs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

#: Module and function of each procedure; a module is imported when a step needs it.
PROCEDURES = {
    "static": ("static", "static_step"),
    "buckle": ("buckling", "buckle_step"),
    "dynamic": ("dynamic", "dynamic_step"),
    "frequency": ("frequency", "frequency_step"),
    "modal dynamic": ("modal", "modal_step"),
    "steady state": ("harmonic", "steady_state_step"),
}


def procedure(name: str) -> Callable[..., Any]:
    """Function of an increment loop, its step and the times at which increments end.

    The name is one of :data:`PROCEDURES`.
    """
    module, function = PROCEDURES[name]
    home = import_module(f"corota.analysis.procedures.{module}")
    found: Callable[..., Any] = getattr(home, function)
    return found
