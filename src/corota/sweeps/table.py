"""The table of a sweep."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import csv
import io
from collections import Counter
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.errors import InputError
from corota.names import choose

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping, Sequence

    from corota.sweeps.variant import Outcome


class Sweep:
    """Parameters and measures of all rows of a sweep.

    ``found["tip"]`` is the column of a parameter or measure; ``table`` the whole.

    Parameters
    ----------
    rows : sequence of mapping
        Parameters of each row.
    measures : sequence of str
    outcomes : sequence of Outcome
    """

    def __init__(
        self,
        rows: Sequence[Mapping[str, Any]],
        measures: Sequence[str],
        outcomes: Sequence[Outcome],
    ) -> None:
        self.parameters = list(rows[0])
        self.measures = list(measures)
        self.outcomes = list(outcomes)
        self._columns: dict[str, list[Any]] = {
            name: [row[name] for row in rows] for name in self.parameters
        }
        for name in self.measures:
            self._columns[name] = [o.values.get(name, float("nan")) for o in outcomes]
        self._columns["seconds"] = [o.seconds for o in outcomes]
        self._columns["error"] = [o.error for o in outcomes]

    def __len__(self) -> int:
        return len(self.outcomes)

    def __getitem__(self, name: str) -> np.ndarray[Any, Any]:
        """Column of a parameter or measure; ``seconds`` and ``error`` are columns, too."""
        name = choose(name, tuple(self._columns), "column of the sweep")
        return np.array(self._columns[name])

    def __repr__(self) -> str:
        failed = f", {len(self.failed)} failed" if self.failed else ""
        return f"Sweep({', '.join(self.parameters + self.measures)}; {len(self)} rows{failed})"

    @property
    def failed(self) -> list[int]:
        """Rows without values; their reasons are in the column ``error``."""
        return [number for number, outcome in enumerate(self.outcomes) if outcome.error]

    @property
    def notes(self) -> dict[str, int]:
        """Warnings and notes of the runs, with the number of rows that had them."""
        return dict(Counter(note for outcome in self.outcomes for note in outcome.notes))

    @property
    def array(self) -> np.ndarray[Any, Any]:
        """Structured array, a field for each column."""
        columns = {name: np.array(values) for name, values in self._columns.items()}
        kinds = [
            (name, object if column.dtype.kind in "OU" else column.dtype)
            for name, column in columns.items()
        ]
        found = np.empty(len(self), dtype=kinds)
        for name, column in columns.items():
            found[name] = column
        return found

    @property
    def table(self) -> Any:
        """``pandas.DataFrame`` where pandas is installed, else the structured array."""
        if find_spec("pandas") is None:
            return self.array
        return import_module("pandas").DataFrame(self._columns)

    def to_csv(self, path: str | os.PathLike[str]) -> Path:
        """Write the table; return the path."""
        from corota.io.atomic_file import replace_text

        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self._columns)
        writer.writerows(zip(*self._columns.values(), strict=True))
        replace_text(Path(path), text.getvalue())
        return Path(path)

    def plot(self, x: str = "", y: str = "", by: str = "", **options: Any) -> Any:
        """Draw a measure over a parameter; see :func:`corota.plots.sweep`.

        Parameters
        ----------
        x, y : str
            Parameter and measure; the first of each by default.
        by : str
            A line for each value of another parameter.
        """
        from corota import plots

        return plots.sweep(self, x or self.parameters[0], y or self.measures[0], by, **options)

    def _repr_html_(self) -> str:
        from html import escape

        head = "".join(f"<th>{escape(name)}</th>" for name in self._columns)
        shown = list(zip(*self._columns.values(), strict=True))[:50]
        body = "".join(
            "<tr>" + "".join(f"<td>{escape(_text(v))}</td>" for v in row) + "</tr>" for row in shown
        )
        more = f"<p>{len(self) - 50} more rows</p>" if len(self) > 50 else ""
        return f"<table><tr>{head}</tr>{body}</table>{more}"

    def column(self, name: str) -> np.ndarray[Any, Any]:
        """Numbers of a column.

        Raises
        ------
        InputError
            If it does not hold numbers.
        """
        values = self[name]
        if values.dtype.kind not in "bif":
            raise InputError(f"column {name!r} does not hold numbers")
        return values.astype(float)


def _text(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)[:80]
