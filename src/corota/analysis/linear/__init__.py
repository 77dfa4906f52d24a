"""Sparse matrices, linear solvers and eigenvalue solvers."""

# SPDX-License-Identifier: BSD-3-Clause
