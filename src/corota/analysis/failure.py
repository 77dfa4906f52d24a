"""Failures of an attempt that a smaller increment may avoid."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations


class ElementFailure(Exception):
    """Elements could not be evaluated at a trial state; a smaller step may help."""


class GiveUp(Exception):
    """No correction of this increment helps; a smaller increment may."""
