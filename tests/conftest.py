"""What all tests share."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import gc
import os
import sys
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

#: Before NumPy is imported. Threads of BLAS that wait for small matrices take ten times the
#: processor time of the work, and as many processes run as there are cores.
for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")


def pytest_configure() -> None:
    """Search for no garbage while tests are collected: they all stay."""
    gc.disable()


def pytest_collection_finish() -> None:
    """Leave what was collected to the end of the process out of all later searches for garbage.

    Pytest makes objects enough for a search with every other test.
    """
    gc.freeze()
    gc.set_threshold(10_000, 20, 10)
    gc.enable()


@pytest.fixture
def quick_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw without fitting the texts: half of the time of a picture, and `test_pictures_fit`'s."""
    monkeypatch.setattr("corota.plots.figure.fit_texts", lambda figure: None)


@pytest.fixture(autouse=True)
def close_figures() -> Iterator[None]:
    """Close what a test has drawn: matplotlib warns when a process keeps more than 20 figures."""
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")
