"""What diagrams, histories and tables read of results: :class:`corota.results.results.Results`."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from corota.arrays import Bools, Floats, Ints
    from corota.mesh import Mesh
    from corota.model.model import Model
    from corota.model.steps import Step
    from corota.results.averaging import Averaging
    from corota.results.frame import Frame


class ResultSource(Protocol):
    """Frames of an analysis and their variables."""

    model: Model
    frames: list[Frame]
    steps: list[Step]

    @property
    def mesh(self) -> Mesh: ...

    @property
    def times(self) -> Floats: ...

    @property
    def averaging(self) -> Averaging: ...

    def frame(self, index: int = -1) -> Frame: ...

    def variables(self, index: int = -1) -> list[str]: ...

    def nodal(self, name: str, index: int = -1, section: int | None = None) -> Floats: ...

    def scalar_names(self) -> list[str]: ...

    def scalar_values(self, name: str) -> Floats: ...

    def sections(self) -> Ints: ...

    def cells(self, name: str, index: int = -1) -> Floats: ...

    def cells_with(self, name: str, index: int = -1) -> Bools: ...

    def history(self, name: str, at: Any = None) -> Any: ...

    def to_dataframe(self, *histories: Any) -> Any: ...
