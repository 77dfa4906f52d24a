"""Stress along the strain paths of a check of material laws."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any

from corota.plots.figure import new_figure, save

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike

    from corota.check.material import LawCheck

#: Size of the picture of one law [inch].
WIDTH, HEIGHT = 9.0, 2.8


def law_curves(checks: Sequence[LawCheck], path: str | PathLike[str] | None = None) -> Any:
    """Draw the component of each path that is largest: stress against strain, a row for each law.

    Parameters
    ----------
    path : path-like, optional
        Picture to write.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(WIDTH, HEIGHT * max(len(checks), 1), path is None)
    n = max((len(c.curves) for c in checks), default=1)
    for row, check in enumerate(checks):
        for column, (name, (strain, stress)) in enumerate(check.curves.items()):
            ax = figure.add_subplot(len(checks), n, row * n + column + 1)
            k = int(abs(strain).max(axis=0).argmax())
            ax.plot(strain[:, k], stress[:, k])
            ax.set_title(f"{check.name}, {check.plane}: {name}", fontsize="small")
            ax.set_xlabel("strain " + ("xx", "yy", "xy")[k])
            if column == 0:
                ax.set_ylabel("stress [force/length^2]")
    if path is not None:
        save(figure, path)
    return figure
