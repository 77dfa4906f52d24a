"""Run the command line with ``python -m corota``."""

# SPDX-License-Identifier: BSD-3-Clause
from corota.cli import program

if __name__ == "__main__":
    program()
