"""Times and memory as ratios inside one run."""

# SPDX-License-Identifier: BSD-3-Clause
