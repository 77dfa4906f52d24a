"""Analyses on several processes: communication and the partition of the elements."""

# SPDX-License-Identifier: BSD-3-Clause
