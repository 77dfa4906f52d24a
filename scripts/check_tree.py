"""Check what no linter sees: sizes, license lines, foreign addresses, changelog, import circles."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import house_facts

ROOT = Path(__file__).resolve().parent.parent
MAX_KILOBYTES = 600
SPDX = "SPDX-License-Identifier: BSD-3-Clause"
SOURCES = {".py", ".pyi", ".rs", ".sh"}
#: What may stand in the root. A run writes its files beside its deck: one that was started here
#: without a folder shows as a name that is missing from this list.
ROOT_NAMES = frozenset(
    [
        ".cargo",
        ".ci",
        ".gitattributes",
        ".github",
        ".gitignore",
        ".pre-commit-config.yaml",
        "CHANGELOG.md",
        "CITATION.cff",
        "CODE_OF_CONDUCT.md",
        "CONTRIBUTING.md",
        "Cargo.lock",
        "Cargo.toml",
        "LICENSE",
        "Makefile",
        "README.md",
        "SECURITY.md",
        "benchmarks",
        "docs",
        "examples",
        "notebooks",
        "packaging",
        "pyproject.toml",
        "requirements-build.in",
        "requirements-build.txt",
        "requirements-dev.in",
        "requirements-dev.txt",
        "requirements-docs.in",
        "requirements-docs.txt",
        "requirements-mesh.in",
        "requirements-mesh.txt",
        "requirements-optimize.in",
        "requirements-optimize.txt",
        "requirements-view.in",
        "requirements-view.txt",
        "requirements.txt",
        "rust",
        "rustfmt.toml",
        "scripts",
        "src",
        "tests",
    ]
)
REGISTRY = re.compile(r"--(extra-)?index-url|--find-links|^# .*https?://", re.MULTILINE)


def tracked() -> list[Path]:
    """Files under version control, relative to the root."""
    listing = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout
    return [Path(name) for name in listing.split("\0") if name and (ROOT / name).is_file()]


def faults(path: Path) -> list[str]:
    """List what is wrong with one file.

    Parameters
    ----------
    path : Path
        Relative to the root.
    """
    file = ROOT / path
    found = []
    if path.parts[0] not in ROOT_NAMES:
        found.append("is none of the names of the root (ROOT_NAMES in scripts/check_tree.py)")
    size = file.stat().st_size
    if size > MAX_KILOBYTES * 1024:
        found.append(f"{size // 1024} kB; at most {MAX_KILOBYTES}")
    if path.suffix in SOURCES:
        text = file.read_text(encoding="utf-8")
        if text.strip() and SPDX not in text[:2000]:
            found.append(f"no line '{SPDX}' at its head")
    pins = path.name.startswith("requirements")
    if pins and REGISTRY.search(file.read_text(encoding="utf-8")):
        found.append("holds the address of a registry")
    return found


def main() -> int:
    """Print the faults; 1 if there are any."""
    lines = [f"{path}: {fault}" for path in tracked() for fault in faults(path)]
    if "## [Unreleased]" not in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"):
        lines.append("CHANGELOG.md: no section '## [Unreleased]'")
    graph = house_facts.imports(ROOT)
    lines += [
        f"modules import each other in a circle: {', '.join(sorted(group))}"
        for group in house_facts.circles(graph)
    ]
    print("\n".join(lines) if lines else "tree: sizes, licenses, pins and imports are in order")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
