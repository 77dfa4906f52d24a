"""Outcomes of a campaign in a file: one that was ended goes on where it was."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

#: Where the stores are, from the root of the repository.
FOLDER = Path(__file__).resolve().parents[2] / "build"


class CampaignStore:
    """Outcomes by case; each is on disk as soon as it is set.

    Parameters
    ----------
    name : str
        Of the file in ``build``, without its ending.
    fresh : bool
        Forget what is there.
    """

    def __init__(self, name: str, fresh: bool = False) -> None:
        FOLDER.mkdir(exist_ok=True)
        self._path = FOLDER / f"{name}.jsonl"
        if fresh:
            self._path.unlink(missing_ok=True)
        lines = self._path.read_text().splitlines() if self._path.exists() else []
        self._outcomes = {json.dumps(row["case"]): row["outcome"] for row in map(json.loads, lines)}

    def __contains__(self, case: Any) -> bool:
        return json.dumps(case) in self._outcomes

    def __getitem__(self, case: Any) -> Any:
        return self._outcomes[json.dumps(case)]

    def __setitem__(self, case: Any, outcome: Any) -> None:
        self._outcomes[json.dumps(case)] = outcome
        # Opened for each: parts of a campaign in other processes append to the same file.
        with open(self._path, "a", encoding="utf-8") as file:
            file.write(json.dumps({"case": case, "outcome": outcome}) + "\n")


__all__ = ["CampaignStore"]
