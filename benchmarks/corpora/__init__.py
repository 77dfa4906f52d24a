"""Models, decks, meshes and drawings with their answers; some compare them when they are run."""

# SPDX-License-Identifier: BSD-3-Clause
