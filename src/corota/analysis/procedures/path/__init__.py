"""Equilibrium paths: arc length, displacement control, stability and branches."""

# SPDX-License-Identifier: BSD-3-Clause
