"""What another kind of processor changes: claims of a run there beside the published ones of the same commit.

`python -m experiments.site.processor TABLES` keeps the comparison with the tables of such a run in docs/trials, and
writes what the note on number format says of it. `python -m experiments.site processor` writes the note alone.
"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

import logging
import sys
from collections.abc import Hashable, Mapping, Sequence
from io import StringIO
from pathlib import Path
from typing import Any

import pandas as pd

from experiments.evaluation.tables.layout import markdown_table
from experiments.intervals.number import interval_text, number_text
from experiments.settings.verdicts import OPEN
from experiments.site.blocks import with_block
from experiments.site.readme import CLAIMS
from experiments.site.snapshot import SNAPSHOT, run_renewal
from mobnet.core.errors import DataError, misfit
from mobnet.core.files import read_text, write_text

log = logging.getLogger(__name__)
NOTE = Path("docs/notes/precision.md")
KEPT = Path("docs/trials/processor.csv")
JUDGED = ("value", "low", "high", "verdict")  # of a claim, once of each run
HERE, THERE = "", "_there"  # endings of the columns of the published run and of the other one
BLOCK = "processor"


def compared(published: pd.DataFrame, there: pd.DataFrame) -> pd.DataFrame:
    """Return a row for each claim of two runs: unit, and number, interval and verdict of both.

    Raises:
        DataError: the runs judge different claims.
    """
    differing = set(published["claim"]) ^ set(there["claim"])
    if differing:
        raise DataError(misfit(f"claim {min(differing)}, which one run has,", "runs of one commit"))
    columns = ["claim", "statement", "unit", *JUDGED]
    return published[columns].merge(there[["claim", *JUDGED]], on="claim", suffixes=(HERE, THERE))


def told(rows: pd.DataFrame) -> str:
    """Return what the note says: how many numbers and verdicts differ, by how much, and the verdicts that do."""
    numbers = rows.dropna(subset=["value", "value_there"])
    moved = numbers[numbers["value"] != numbers["value_there"]]
    turned = rows[rows["verdict"] != rows["verdict_there"]]
    decided = turned[(turned["verdict"] != OPEN) & (turned["verdict_there"] != OPEN)]
    text = f"{len(moved)} of {len(rows)} claims have another number"
    if len(moved):
        half_interval = (moved["high"] - moved["low"]) / 2.0
        shift = ((moved["value_there"] - moved["value"]).abs() / half_interval).median()
        text += f"; half of these moved by less than {number_text(shift)} of half their interval"
    text += f". {len(turned)} have another verdict; {len(decided)} of these are decided in both runs:"
    lines = [[row["claim"], *_judged(row, HERE), *_judged(row, THERE)] for row in turned.to_dict("records")]
    head = ["claim", "published", "", "on the other processor", ""]
    return f"{text}\n\n{markdown_table(head, lines, left=1)}"


def _judged(row: Mapping[Hashable, Any], ending: str) -> list[str]:
    """Return number with interval, and verdict, of one of the runs."""
    value, low, high, verdict = (row[name + ending] for name in JUDGED)
    return [f"{number_text(value)} {interval_text(low, high)}", str(verdict)]


def renew() -> None:
    """Write into the note what the kept comparison says.

    Raises:
        DataError: there is none, or the note has no place for it.
    """
    write_text(NOTE, with_block(read_text(NOTE), BLOCK, told(_frame(KEPT)), NOTE))


def keep(words: Sequence[str]) -> None:
    """Keep the comparison with the tables of a run, in the folder that is the only word, and renew the note.

    Raises:
        DataError: there is another number of words, a file is missing, or the runs judge different claims.
    """
    if len(words) != 1:
        raise DataError(misfit(f"{len(words)} words", "the folder of the tables of a run on another processor"))
    rows = compared(_frame(SNAPSHOT / CLAIMS), _frame(Path(words[0]) / CLAIMS))
    write_text(KEPT, rows.to_csv(index=False, lineterminator="\n"))
    renew()
    log.info("%s: renewed", NOTE)


def _frame(path: Path) -> pd.DataFrame:
    """Return a CSV as a frame; a DataError where it is missing."""
    return pd.read_csv(StringIO(read_text(path)))


if __name__ == "__main__":
    sys.exit(run_renewal(lambda: keep(sys.argv[1:]), log))
