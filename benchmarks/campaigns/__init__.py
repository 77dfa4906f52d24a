"""Large sets of random or listed cases: what fails, with what, how often."""

# SPDX-License-Identifier: BSD-3-Clause
