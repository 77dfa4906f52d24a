"""Errors of an interpreter that runs out of memory are :class:`corota.ResourceError`."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import pytest

import corota as ct
from corota.errors import memory_errors


@pytest.mark.parametrize(
    "error",
    [
        MemoryError(),
        SystemError("error return without exception set"),
        SystemError("<built-in function exec> returned NULL without setting an exception"),
    ],
    ids=repr,
)
def test_a_shortage_is_a_resource_error(error: BaseException) -> None:
    with pytest.raises(ct.ResourceError), memory_errors():
        raise error


def test_other_errors_of_the_interpreter_stay() -> None:
    with pytest.raises(SystemError, match="bad argument"), memory_errors():
        raise SystemError("bad argument to internal function")
