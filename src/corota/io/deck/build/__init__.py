"""From the cards of a deck to a model."""

# SPDX-License-Identifier: BSD-3-Clause
