"""The doctests of the package are collected, not only requested."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import corota


def examples_by_module() -> dict[str, int]:
    """Number of docstrings with examples in each module of the package."""
    finder = doctest.DocTestFinder(exclude_empty=True)
    counts = {}
    for info in pkgutil.walk_packages(corota.__path__, "corota."):
        if info.name.startswith("corota._"):
            continue
        tests = finder.find(importlib.import_module(info.name))
        counts[info.name] = sum(bool(t.examples) for t in tests)
    return {name: count for name, count in counts.items() if count}


def test_doctests_are_collected(pytestconfig: pytest.Config) -> None:
    assert pytestconfig.getoption("doctestmodules")
    assert "src" in pytestconfig.getini("testpaths")
    found = examples_by_module()
    assert "corota.model.model" in found, found
