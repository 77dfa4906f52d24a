"""Drivers of other programs on problem P1, each a process that prints one line of JSON."""

# SPDX-License-Identifier: BSD-3-Clause
