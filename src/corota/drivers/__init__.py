"""Solution procedures: what is done per iteration and above."""

# SPDX-License-Identifier: BSD-3-Clause
