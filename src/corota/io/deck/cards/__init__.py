"""One function for each keyword, grouped by subject."""

# SPDX-License-Identifier: BSD-3-Clause
