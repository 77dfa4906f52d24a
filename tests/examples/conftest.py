"""Loads the example scripts, which are not part of the package."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Protocol

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


class Load(Protocol):
    def __call__(self, path: str) -> ModuleType: ...


@pytest.fixture(scope="session")
def examples() -> Path:
    return EXAMPLES


@pytest.fixture(scope="session")
def load() -> Load:
    """Import an example by its path under ``examples``."""

    def imported(path: str) -> ModuleType:
        name = "example_" + Path(path).stem
        if name not in sys.modules:
            spec = importlib.util.spec_from_file_location(name, EXAMPLES / path)
            assert spec
            assert spec.loader
            module = importlib.util.module_from_spec(spec)
            sys.modules[name] = module
            spec.loader.exec_module(module)
        return sys.modules[name]

    return imported
