"""The description of the model in a result file: for reports, which do not read the deck."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from corota.io.datasets import store
from corota.io.regular_file import parse_json
from corota.model.description import describe

if TYPE_CHECKING:
    from collections.abc import Sequence

    from corota.model.model import Model
    from corota.model.steps import Step

#: Name of the data set in the group of the program.
NAME = "model"


def store_description(group: Any, model: Model, steps: Sequence[Step]) -> None:
    """Write :func:`corota.model.description.describe` as JSON into an HDF5 group."""
    text = json.dumps(describe(model, steps), separators=(",", ":"))
    data = np.frombuffer(text.encode(), np.uint8)
    store(group, NAME, data, level=4)


def description_of_results(group: Any) -> dict[str, Any]:
    """The description in a result file; empty in those of versions without."""
    if NAME not in group:
        return {}
    found: dict[str, Any] = parse_json(bytes(group[NAME][:]))
    return found
