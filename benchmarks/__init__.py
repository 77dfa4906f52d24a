"""Benchmarks: ratios inside one run on one machine."""

# SPDX-License-Identifier: BSD-3-Clause
