"""What the tests share; ``tests`` is on the path."""

# SPDX-License-Identifier: BSD-3-Clause
