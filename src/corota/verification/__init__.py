"""Reference problems with their sources and values."""

# SPDX-License-Identifier: BSD-3-Clause
