"""Meshes of Gmsh."""

# SPDX-License-Identifier: BSD-3-Clause
