"""Linear and nonlinear constraints, eliminated from the equations."""

# SPDX-License-Identifier: BSD-3-Clause
