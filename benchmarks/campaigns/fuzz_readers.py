"""Coverage-guided fuzzing of the readers of decks and meshes, with atheris.

    python -m benchmarks fuzz_readers [seconds] [corpus]

Needs ``pip install atheris``, which is no requirement of anything else here. What is found is
written by atheris as ``crash-*`` or ``timeout-*`` into the working folder.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import sys
import tempfile
import warnings
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
#: Seconds that one input may take, and its bytes.
LIMIT, LONGEST = 20, 4000


def main() -> int:
    """Fuzz for a number of seconds; 600 by default."""
    try:
        import atheris
    except ImportError:
        sys.stderr.write("atheris is not installed: pip install atheris\n")
        return 5
    seconds = int(sys.argv[1]) if len(sys.argv) > 1 else 600
    corpus = Path(sys.argv[2] if len(sys.argv) > 2 else ROOT / "build" / "corpus")
    corpus.mkdir(parents=True, exist_ok=True)
    sys.path.insert(0, str(ROOT / "tests" / "io"))
    import mesh_seeds
    import seeds

    texts = [text.encode() for text in seeds.SEEDS]
    for number, raw in enumerate([*texts, *mesh_seeds.SEEDS]):
        (corpus / f"seed-{number}").write_bytes(raw)
    with atheris.instrument_imports(include=["corota.io", "corota.mesh"]):
        import corota as ct
        import corota.io.deck.read
        import corota.io.gmsh.reader
    warnings.simplefilter("ignore")
    folder = Path(tempfile.mkdtemp())

    def one(data: bytes) -> None:
        path = folder / ("x.msh" if data[:1] == b"$" else "x.inp")
        path.write_bytes(data)
        try:
            ct.mesh.read(path) if path.suffix == ".msh" else ct.read(path)
        except ct.CorotaError as error:
            if not str(error).strip():
                raise RuntimeError("a refusal without a message") from error

    options = [f"-max_total_time={seconds}", f"-timeout={LIMIT}", f"-max_len={LONGEST}"]
    atheris.Setup([sys.argv[0], str(corpus), *options], one)
    atheris.Fuzz()
    return 0


if __name__ == "__main__":
    sys.exit(main())
