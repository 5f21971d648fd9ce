"""Run the benchmarks: `./reproduce bench [NAME ...]`, or `python -m benchmarks` in an environment that has mobnet.

The quick ones time a pair in one run and one thread, in turns, so that a ratio holds on a busy machine too; a ratio
above 1 means that ours is faster. The long ones, run when named, hold quantities against bounds. Prints one table and
writes it to results/bench.csv.
"""

import csv
import importlib
import sys
from pathlib import Path

from experiments.running.words import bench_parser
from mobnet.core.errors import not_accepted
from mobnet.core.files import atomic_path
from mobnet.core.heartbeat import heartbeat
from mobnet.core.machine import one_thread
from mobnet.core.printed import watch_output

NAMES = (
    "collect_speed",
    "observer_speed",
    "train_speed",
    "gpu_speed",
    "step_latency",
    "onnx_latency",
    "estimate_speed",
    "loop_speed",
    "runtime_tick",
)
LONG = ("collect_growth", "collect_hour", "log_speed", "torque_amplitude", "walk_quality")  # minutes each
BEFORE = ("benchmark", "name", "ours", "reference", "unit", "ratio", "ratio_min")  # columns that come first
BOUNDS = {"bar": "ratio", "at_least": "at least", "at_most": "at most"}  # columns next, and how a table says it
Row = dict[str, float | str]


def main() -> int:
    """Run those asked for; return 1 if one misses its bar."""
    parser = bench_parser()
    options = parser.parse_args()
    for name in set(options.names) - {*NAMES, *LONG}:
        parser.error(not_accepted("NAME", name, [*NAMES, *LONG]))
    rows: list[Row] = []
    one_thread()
    for name in options.names or NAMES:
        print(f"running {name}", file=sys.stderr, flush=True)
        with heartbeat():
            rows += [{"benchmark": name, **row} for row in importlib.import_module(f"benchmarks.{name}").main()]
    print(table(rows))
    _write(rows, options.out)
    return int(any(misses(row) for row in rows))


def table(rows: list[Row]) -> str:
    """Return the rows as lines of a Markdown table."""
    lines = [["what", "ours", "reference", "unit", "ratio", "least", "bar"]]
    for row in rows:
        reference, ratio, least = (
            format(row[key], form) if key in row else ""
            for key, form in (("reference", ".4g"), ("ratio", ".2f"), ("ratio_min", ".2f"))
        )
        bounds = [f"{words} {row[key]:g}" for key, words in BOUNDS.items() if key in row]
        bar = ", ".join(bounds) + (" missed" if misses(row) else "")
        lines.append([str(row["name"]), f"{row['ours']:.4g}", reference, str(row["unit"]), ratio, least, bar])
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    lines.insert(1, ["-" * width for width in widths])
    return "\n".join("| " + " | ".join(map(str.ljust, line, widths)) + " |" for line in lines)


def misses(row: Row) -> bool:
    """Return whether the median ratio is below the bar, or ours outside its bounds; what is not a number is outside."""
    faster = float(row["ratio"]) >= float(row["bar"]) if "bar" in row else True
    above = float(row["ours"]) >= float(row["at_least"]) if "at_least" in row else True
    below = float(row["ours"]) <= float(row["at_most"]) if "at_most" in row else True
    return not (faster and above and below)


def _write(rows: list[Row], path: Path) -> None:
    """Write all columns that a row has."""
    first = (*BEFORE, *BOUNDS)
    others = {name: None for row in rows for name in row if name not in first}
    with atomic_path(path) as temporary, Path(temporary).open("w", newline="") as handle:
        writer = csv.DictWriter(handle, [*first, *others])
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    watch_output()
    sys.exit(main())
