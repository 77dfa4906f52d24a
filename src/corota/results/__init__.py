"""Results of an analysis: frames, histories, variables and observers."""

# SPDX-License-Identifier: BSD-3-Clause
from corota.results.observer import BaseObserver, Iteration, Observer
from corota.results.results import Frame, PointFields, Results

__all__ = ["BaseObserver", "Frame", "Iteration", "Observer", "PointFields", "Results"]
