"""One problem per module: its docstring describes it, its ``PROBLEM`` measures it."""

# SPDX-License-Identifier: BSD-3-Clause
