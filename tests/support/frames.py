"""The models of frames, for the tests of paths and buckling."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from corota.verification.frame_models import (
    column,
    deep_arch,
    euler_load,
    lee_frame,
    williams_toggle,
)
from corota.verification.models import nearest as node_at

__all__ = ["column", "deep_arch", "euler_load", "lee_frame", "node_at", "williams_toggle"]
