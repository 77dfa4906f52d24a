"""Contact and surface ties: pairs, states, multipliers and the active-set strategy."""

# SPDX-License-Identifier: BSD-3-Clause
