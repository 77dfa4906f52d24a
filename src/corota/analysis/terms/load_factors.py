"""Factors of loads and supports over a step: its ramp, and amplitudes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from corota.errors import Location, ModelError
from corota.model.integrated import IntegratedAmplitude
from corota.model.loads import Amplitude

if TYPE_CHECKING:
    from collections.abc import Mapping

    from corota.analysis.load_history import LoadHistory
    from corota.arrays import Floats


class LoadFactors:
    """Factors of the loads and supports of a step at its times.

    Parameters
    ----------
    amplitudes : mapping of str to Amplitude
        Those of the model.

    Attributes
    ----------
    names : list of str
        Of amplitudes, by the index that loads have for them; the first stands for none.
    runs_on, moves_on : ndarray of bool, shape (n_names,)
        Amplitudes that continue in later steps (of total time), and those that move supports from
        their position at the start of the step.
    period, time : float
        Length of the step, and total time at its start [time].
    ramp : bool
        Whether loads without an amplitude grow over the step.
    abrupt : bool
        Whether removed loads vanish at once.

    Raises
    ------
    ModelError
        If an amplitude is none.
    """

    recomputed: ClassVar[frozenset[str]] = frozenset({"amplitudes", "names", "runs_on", "moves_on"})

    def __init__(self, amplitudes: Mapping[str, Amplitude]) -> None:
        for name, table in amplitudes.items():
            if not isinstance(table, Amplitude | IntegratedAmplitude):
                raise ModelError(
                    f"amplitude {name!r} is no Amplitude but {type(table).__name__}: write "
                    f"model.amplitudes[{name!r}] = ct.Amplitude(times, values)"
                )
        self.amplitudes = amplitudes
        self.names = ["", *amplitudes]
        tables = amplitudes.values()
        self.runs_on = np.array([False, *(a.total_time for a in tables)])
        self.moves_on = np.array([False, *(isinstance(a, IntegratedAmplitude) for a in tables)])
        self.period = 1.0
        self.time = 0.0
        self.ramp = True
        self.abrupt = False

    def growth(self, step_time: float) -> float:
        """Fraction of the change to a new value."""
        return step_time / self.period if self.ramp else 1.0

    def removal(self, step_time: float) -> float:
        """Removed fraction of a load that the step removes."""
        return 1.0 if self.abrupt else step_time / self.period

    def of_amplitudes(self, step_time: float) -> Floats:
        """Values of all amplitudes, shape (n_names,); 1 for none."""
        factors = [1.0]
        for i in range(1, len(self.names)):
            table, start = self.table(i)
            factors.append(table(step_time + start))
        return np.array(factors)

    def values(
        self, history: LoadHistory, step_time: float, amplitudes: Floats | None = None
    ) -> Floats:
        """Values of a history; `amplitudes`: of that time, if they are known."""
        if amplitudes is None:
            amplitudes = self.of_amplitudes(step_time)
        return history.at(self.growth(step_time), self.removal(step_time), amplitudes)

    def table(self, index: int) -> tuple[Amplitude, float]:
        """An amplitude, and its own time at the start of the step [time]."""
        table = self.amplitudes[self.names[index]]
        return table, self.time if table.total_time else 0.0

    def index(self, name: str, where: Location | None) -> int:
        """Index of an amplitude.

        Raises
        ------
        ModelError
            If there is none of that name.
        """
        if name not in self.names:
            known = ", ".join(self.names[1:]) or "none"
            raise ModelError(f"no amplitude named {name!r}; there are: {known}", where)
        return self.names.index(name)
