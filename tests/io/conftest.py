"""Let the tests of this folder share their decks."""

# SPDX-License-Identifier: BSD-3-Clause
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))
# Last: a benchmark must not hide a package of its name.
sys.path.append(str(HERE.parents[1] / "benchmarks" / "campaigns"))
