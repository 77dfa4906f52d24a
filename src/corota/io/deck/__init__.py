"""Decks of CalculiX and Abaqus: lexer, cards, model building, writing."""

# SPDX-License-Identifier: BSD-3-Clause
