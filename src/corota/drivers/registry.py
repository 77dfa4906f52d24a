"""The one list of procedures: what a step of each kind runs."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.drivers.buckling import buckle_step
from corota.drivers.dynamics import dynamic_step
from corota.drivers.frequency import frequency_step
from corota.drivers.modal import modal_step, steady_state_step
from corota.drivers.static import static_step

if TYPE_CHECKING:
    from collections.abc import Callable

PROCEDURES: dict[str, Callable[..., Any]] = {
    "static": static_step,
    "buckle": buckle_step,
    "dynamic": dynamic_step,
    "frequency": frequency_step,
    "modal dynamic": modal_step,
    "steady state": steady_state_step,
}
