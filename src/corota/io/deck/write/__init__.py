"""From a model to the cards of a deck."""

# SPDX-License-Identifier: BSD-3-Clause
