"""One module for each procedure, and their table."""

# SPDX-License-Identifier: BSD-3-Clause
