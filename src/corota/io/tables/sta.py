"""Job monitor files in CalculiX's layout: ``.sta`` an increment, ``.cvg`` an iteration a line.

Source: CalculiX 2.20, ``writesta.f``, ``writestadiv.f``, ``writecvg.f``.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

from corota.io.tables.dat_numbers import fortran

if TYPE_CHECKING:
    from corota.results.observer import Iteration
    from corota.results.results import Frame

STA_HEAD = (
    "SUMMARY OF JOB INFORMATION\n"
    "  STEP      INC     ATT  ITRS     TOT TIME     STEP TIME      INC TIME\n"
)
CVG_HEAD = (
    "SUMMARY OF C0NVERGENCE INFORMATION\n"
    "  STEP   INC  ATT   ITER     CONT.   RESID.        CORR.      RESID.      CORR.\n"
    "                              EL.    FORCE         DISP       FLUX        TEMP.\n"
    "                              (#)     (%)           (%)        (%)         (%)\n"
)

#: Replacement for a residual that is NaN.
LARGEST = 9.999e98


def sta_line(frame: Frame, attempt: int, dt: float) -> str:
    """Line of an accepted increment.

    Parameters
    ----------
    attempt : int
        From 1.
    dt : float
        Size of the increment [time].
    """
    iterations = int(frame.scalars.get("iterations", 0))
    times = " ".join(f"{fortran(t, 6):>13}" for t in (frame.time, frame.step_time, dt))
    return f" {frame.step:5d} {frame.increment:10d} {attempt:5d} {iterations:5d} {times}\n"


def cvg_line(info: Iteration, largest: float) -> str:
    """Line of an iteration.

    Parameters
    ----------
    largest : float
        Largest displacement increment so far [length]; the correction is in percent of it.
    """
    share = 100.0 * info.correction / largest if largest > 0.0 else 0.0
    numbers = (100.0 * info.residual, share, 0.0, 0.0)
    # An iteration may overflow before it is given up; the file shows a large number.
    columns = " ".join(f"{fortran(x if x < LARGEST else LARGEST, 4):>11}" for x in numbers)
    return (
        f" {info.step:5d} {info.increment:5d} {info.attempt:5d} {info.iteration:5d} {0:8d} "
        f"{columns}\n"
    )


def sta_failed(
    step: int,
    increment: int,
    attempt: int,
    iterations: int,
    reached: tuple[float, float],
    dt: float,
) -> str:
    """Line of an attempt that was given up, marked with U as CalculiX does.

    Parameters
    ----------
    reached : tuple of float
        Total and step time reached so far [time].
    dt : float
        Size of the increment that was tried [time].
    """
    times = " ".join(f"{fortran(t, 6):>13}" for t in (*reached, dt))
    return f" {step:5d} {increment:10d} {attempt:5d}U{iterations:5d} {times}\n"
