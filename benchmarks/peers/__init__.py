"""Drivers of the programs: each solves a problem file as a process and prints one line of JSON.

``python -m benchmarks.peers.run_NAME problem.npz [key=value ...]``; see ``shared`` for the line.
"""

# SPDX-License-Identifier: BSD-3-Clause
