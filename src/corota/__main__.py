"""Run the command line with ``python -m corota``."""

# SPDX-License-Identifier: BSD-3-Clause
import sys

from corota.cli import main

if __name__ == "__main__":
    sys.exit(main())
