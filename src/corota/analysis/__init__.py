"""Equations, Newton's method and procedures: from a model to results."""

# SPDX-License-Identifier: BSD-3-Clause
