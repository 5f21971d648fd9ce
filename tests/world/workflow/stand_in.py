"""Stands in for the script of each rule where a test stops runs: it writes what follows from what it reads.

What it writes depends on the arguments of the job and on the bytes of its inputs, so that a stale file is seen. It
takes a moment, waits while one file of the project's folder is there, and fails where another one names its rule.
"""

import hashlib
import time
from pathlib import Path

MOMENT_S = 0.15
FAILING, HELD = Path("failing.txt"), Path("held.txt")


def files_of(place):
    """Yield the files of an input."""
    if place.is_dir():
        yield from sorted(path for path in place.iterdir() if not path.name.startswith("."))
    else:
        yield place


digest = hashlib.sha256(repr(snakemake.params.given).encode())
for name in snakemake.input:
    for path in files_of(Path(name)):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
time.sleep(MOMENT_S)
while HELD.exists():
    time.sleep(MOMENT_S)
if FAILING.is_file() and FAILING.read_text() == snakemake.rule:
    raise SystemExit(1)
for name in snakemake.output:
    made = Path(name)
    files = [made] if made.suffix else [made / "s1.parquet", made / "s2.parquet"]
    for path in files:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{digest.hexdigest()} {path.name}\n")
        time.sleep(MOMENT_S / 2)
