"""Outcome of one problem of the catalog."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from corota.verification.catalogue import Study, Value


@dataclass
class Outcome:
    """Outcome of one problem.

    Parameters
    ----------
    seconds : float
        Of the measurement.
    error : str
        Why there are no values.
    """

    name: str
    values: list[Value] = field(default_factory=list)
    seconds: float = 0.0
    error: str = ""
    study: Study | None = None

    @property
    def ok(self) -> bool:
        """Whether there are values and all are within their tolerances."""
        return not self.error and bool(self.values) and all(v.ok for v in self.values)
