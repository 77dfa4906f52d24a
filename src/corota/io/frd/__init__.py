"""Result files of CalculiX, ``.frd``: what cgx, PrePoMax and FreeCAD open."""

# SPDX-License-Identifier: BSD-3-Clause
