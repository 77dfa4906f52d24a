"""The last check before a file: NaN and infinity are refused."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from corota.errors import CorotaError

if TYPE_CHECKING:
    from corota.results.results import Frame


def check_frame(frame: Frame) -> None:
    """Refuse a frame with a NaN or an infinity in it.

    Raises
    ------
    CorotaError
        Internal error: the solver should never have accepted such an increment.
    """
    for name in ("U", "UR", "RF", "F", "V", "A", "C"):
        values = getattr(frame, name)
        if values is not None and name not in frame.absent:
            check(frame, name, values)
    for block in frame.fields:
        for name, values in block.values.items():
            check(frame, f"{name} ({block.element})", values)
        check(frame, f"points ({block.element})", block.points)
        check(frame, f"frame rotation ({block.element})", block.frame_rotation)
    for name, value in frame.scalars.items():
        check(frame, name, np.asarray(value))
    for name in ("time", "step_time", "factor"):
        check(frame, name, np.asarray(getattr(frame, name)))


def check(frame: Frame, name: str, values: np.ndarray) -> None:
    """Refuse one array; see :func:`check_frame`."""
    if np.isfinite(values).all():
        return
    bad = np.argwhere(~np.isfinite(values))[0].tolist()
    raise CorotaError(
        f"internal error: {name}{bad or ''} is not finite in step {frame.step}, increment "
        f"{frame.increment}; nothing of this increment was written"
    )
