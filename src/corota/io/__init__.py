"""Input decks, meshes and result files."""

# SPDX-License-Identifier: BSD-3-Clause
