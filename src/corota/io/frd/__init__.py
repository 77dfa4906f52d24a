"""Result files of CalculiX, ``.frd``: for cgx, PrePoMax and FreeCAD."""

# SPDX-License-Identifier: BSD-3-Clause
