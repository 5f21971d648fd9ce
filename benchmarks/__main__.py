"""Run the benchmarks: `./reproduce bench [NAME ...]`, or `python -m benchmarks` in an environment that has mobnet.

Every benchmark times a pair in one run and one thread, in turns, so that a ratio holds on a busy machine too; a ratio
above 1 means that ours is faster. Prints one table and writes it to results/bench.csv.
"""

from __future__ import annotations

import argparse
import csv
import importlib
import sys
from pathlib import Path

from mobnet.core.files import atomic_path

NAMES = ("collect_speed", "observer_speed", "train_speed", "step_latency")
OUT = Path("results") / "bench.csv"
FIRST = ("benchmark", "name", "ours", "reference", "unit", "ratio", "ratio_min", "bar")  # columns that come first
Row = dict[str, float | str]


def main() -> int:
    """Run those asked for; return 1 if one misses its bar."""
    parser = argparse.ArgumentParser(
        prog="./reproduce bench", description="Time pairs in one run and print their ratios."
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of: {', '.join(NAMES)}; all without one")
    parser.add_argument("--out", type=Path, default=OUT, help=f"CSV, default {OUT}")
    options = parser.parse_args()
    for name in set(options.names) - set(NAMES):
        parser.error(f"NAME: {name!r} is not accepted; accepted: {', '.join(NAMES)}")
    rows: list[Row] = []
    for name in options.names or NAMES:
        print(f"running {name}", file=sys.stderr, flush=True)
        rows += [{"benchmark": name, **row} for row in importlib.import_module(f"benchmarks.{name}").main()]
    print(table(rows))
    _write(rows, options.out)
    return int(any(_misses(row) for row in rows))


def table(rows: list[Row]) -> str:
    """Return the rows as lines of a Markdown table."""
    lines = [["what", "ours", "reference", "unit", "ratio", "least", "bar"]]
    for row in rows:
        bar = f"{row['bar']:g}{' missed' if _misses(row) else ''}" if "bar" in row else ""
        least = f"{row['ratio_min']:.2f}" if "ratio_min" in row else ""
        numbers = [f"{row['ours']:.4g}", f"{row['reference']:.4g}", str(row["unit"]), f"{row['ratio']:.2f}"]
        lines.append([str(row["name"]), *numbers, least, bar])
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    lines.insert(1, ["-" * width for width in widths])
    return "\n".join("| " + " | ".join(map(str.ljust, line, widths)) + " |" for line in lines)


def _misses(row: Row) -> bool:
    """Return whether the median ratio is below the bar."""
    return float(row["ratio"]) < float(row.get("bar", 0.0))


def _write(rows: list[Row], path: Path) -> None:
    """Write all columns that a row has."""
    others = {name: None for row in rows for name in row if name not in FIRST}
    with atomic_path(path) as temporary, Path(temporary).open("w", newline="") as handle:
        writer = csv.DictWriter(handle, [*FIRST, *others])
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    sys.exit(main())
