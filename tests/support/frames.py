"""The models of the example of frames, for the tests of paths and buckling."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import importlib.util
from pathlib import Path

_FILE = Path(__file__).parents[2] / "examples" / "frames" / "frames.py"
_SPEC = importlib.util.spec_from_file_location("example_frames", _FILE)
assert _SPEC is not None
assert _SPEC.loader is not None
example = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(example)

column = example.column
deep_arch = example.deep_arch
euler_load = example.euler_load
lee_frame = example.lee_frame
node_at = example.node_at
williams_toggle = example.williams_toggle

__all__ = ["column", "deep_arch", "euler_load", "lee_frame", "node_at", "williams_toggle"]
