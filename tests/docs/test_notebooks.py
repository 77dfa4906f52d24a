"""The notebooks are well formed and run from top to bottom in a fresh namespace."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

NOTEBOOKS = sorted((Path(__file__).parents[2] / "notebooks").glob("*.ipynb"))


def code_of(notebook: dict[str, Any]) -> list[str]:
    """Code cells; commands of IPython are left out, as in a plain interpreter."""
    cells = ["".join(c["source"]) for c in notebook["cells"] if c["cell_type"] == "code"]
    return [
        "\n".join(line for line in text.splitlines() if not line.lstrip().startswith(("%", "!")))
        for text in cells
    ]


def test_there_are_seven() -> None:
    assert len(NOTEBOOKS) == 7


#: These take seconds; they run with the slow tests.
LONG = ("02_snap_fit", "05_impact")


@pytest.mark.usefixtures("quick_pictures")
@pytest.mark.parametrize(
    "path",
    [pytest.param(p, marks=[pytest.mark.slow] if p.stem in LONG else []) for p in NOTEBOOKS],
    ids=lambda p: p.stem,
)
def test_a_notebook_runs(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    notebook = json.loads(path.read_text(encoding="utf-8"))
    assert (notebook["nbformat"], notebook["metadata"]["kernelspec"]["name"]) == (4, "python3")
    assert all(not c.get("outputs") for c in notebook["cells"]), "stored without outputs"
    names: dict[str, Any] = {"__name__": "__main__"}
    for number, text in enumerate(code_of(notebook), start=1):
        exec(compile(text, f"{path.name}[{number}]", "exec"), names)
