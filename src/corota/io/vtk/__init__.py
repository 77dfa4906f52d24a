"""Result files for ParaView and PyVista."""

# SPDX-License-Identifier: BSD-3-Clause
