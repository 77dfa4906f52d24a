"""Periodic cells: homogenized stress and tangent, waves, and the onset of patterns."""

# SPDX-License-Identifier: BSD-3-Clause
from corota.cells.cell import PeriodicCell
from corota.cells.homogenized import elastic_constants, ellipticity
from corota.cells.onset import Onset
from corota.cells.waves import Waves

__all__ = ["Onset", "PeriodicCell", "Waves", "elastic_constants", "ellipticity"]
