"""Tables of the docs: methods against each other, closed forms and other programs."""

# SPDX-License-Identifier: BSD-3-Clause
