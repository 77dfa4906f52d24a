"""Many runs of one model: parameters, measures, workers, a table that can be resumed."""

# SPDX-License-Identifier: BSD-3-Clause
from corota.sweeps.design import grid, sample
from corota.sweeps.run import sweep
from corota.sweeps.table import Sweep

__all__ = ["Sweep", "grid", "sample", "sweep"]
