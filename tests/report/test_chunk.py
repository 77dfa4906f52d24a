"""Chunks of the report: what is packed comes back, rounded by no more than it says."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

from corota.report.chunk import pack, rounded, unpack


def test_round_trip() -> None:
    arrays = {
        "single": np.arange(6, dtype=np.float32).reshape(3, 2),
        "double": np.array([1.0 / 3.0, np.nan, -1e300]),
        "whole": np.array([[-1, 2**31 - 1]]),
        "empty": np.zeros((0, 3)),
    }
    header, found = unpack(pack({"name": "ä", "bad": np.inf, "n": np.int64(3)}, arrays))
    assert header == {"name": "ä", "bad": None, "n": 3}
    for name, array in arrays.items():
        np.testing.assert_array_equal(found[name], array)
        assert found[name].shape == array.shape


@pytest.mark.parametrize("bits", [14, 10])
def test_rounded_error(bits: int) -> None:
    rng = np.random.default_rng(1)
    values = rng.normal(size=4000) * 10.0 ** rng.integers(-20, 20, 4000)
    error = np.abs(rounded(values, bits) / values - 1.0)
    assert error.max() < 2.0 ** -(bits + 1) * (1.0 + 1e-6) + 1e-7
    assert error.max() > 2.0 ** -(bits + 2)


def test_rounded_keeps_zeros_and_signs() -> None:
    values = np.array([0.0, -0.0, 1.0, -2.0, 3.4e38, -3.4e38])
    np.testing.assert_allclose(rounded(values), values.astype(np.float32), rtol=1e-4)
    assert np.isfinite(rounded(values)).all()
