"""The studies of ``comparison``: each module here is one, and has ``CASES``."""

# SPDX-License-Identifier: BSD-3-Clause
