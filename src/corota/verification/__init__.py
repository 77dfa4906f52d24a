"""Reference problems with their sources and values; ``corota verify`` runs them."""

# SPDX-License-Identifier: BSD-3-Clause
