"""The page docs/frames.md: the columns of the frames that tables are made from.

`python -m experiments.site frames` writes it; a test fails when it is out of date.
"""

from pathlib import Path

from experiments.evaluation.number.frames import (
    CONTACTS,
    CURVES,
    FALLS,
    HITS,
    NETWORKS,
    PROMISES,
    SCORES,
    SWINGS,
    THRESHOLDS,
    TRAININGS,
    TRIALS,
    TRUSTED,
    WHY,
    Schema,
)
from experiments.evaluation.tables.layout import markdown_table
from mobnet.core.files import write_text

CARD = Path("docs/frames.md")
HEAD = """# Frames behind the tables

Generated from `experiments.evaluation.number.frames` by `python -m experiments.site frames`: do not
edit.

Jobs write what they measure as files of rows, and a table reads them as pandas frames. Each frame is tidy: a row is one
observation, and other columns say what its numbers are of. A function reads a frame and checks its file; a wrong row is
refused in one line with file, line, value and what is accepted. A number that is missing is NaN.

A table is then made in four steps, each a line or a few:

1. **filter**: `rows_of(hits, leg="LL")` keeps the rows that hold a value; `ordered(hits, detector=[...])` keeps
   those of some detectors and puts groups in their order
2. **group and law**: `measured(hits, ["level", "detector"], {"found": share("found", statistics)}, each="cell")` has a
   row for each group and law: the number with the ends of its interval, its unit and of how many rows it is. `share`,
   `mean` and `counted` are laws, and so is any function of a frame that returns a `Number`
3. **runs of scores**: `runs_of(scores, asked)` joins what a table asks for with its runs, and `number_of(runs,
   statistics)` makes their mean, or what another formula makes of them
4. **look**: `write_look` writes all rows as CSV, and as Markdown and TeX the lines and columns that a `TableLook` picks

Two things are easily lost with frames. A group of which nothing is found vanishes with its rows: `of=` names the flag
that counts, so that the group stays, and `each=` a column of which every group has all values. And a concatenation
forgets the order of values where its parts do not have them in common: `with_all` shows how they do.
"""
FRAMES: dict[str, tuple[str, Schema]] = {
    "scores": ("`read_scores`: numbers of runs, from `results/<scale>/scores`.", SCORES),
    "hits": (
        "`read_hits`: what each detector said of each collision, by each rule of thresholds, from"
        " `results/<scale>/<robot>/detection`.",
        HITS,
    ),
    "swings": ('`read_detection(..., "swings")`: swings that nothing pushes, from the same folder.', SWINGS),
    "promises": ('`read_detection(..., "promises")`: the false alarms that thresholds should have.', PROMISES),
    "thresholds": ('`read_detection(..., "thresholds")`: the thresholds of detectors.', THRESHOLDS),
    "curves": ('`read_detection(..., "curves")`: what detectors find at other thresholds.', CURVES),
    "trials": ("`read_trials`: walks into obstacles, and free ones, from `results/<scale>/<robot>/reactions`.", TRIALS),
    "contacts": ("`contacts_of`: where collisions meet the legs, by estimates and by guesses.", CONTACTS),
    "networks": (
        "`read_trainings`: trained networks, from `results/<scale>/<robot>/networks`.",
        NETWORKS,
    ),
    "trainings": ("`read_trainings`: the epochs of these networks.", TRAININGS),
    "falls": ("`read_frame(..., FALLS)`: falls by random torque, from `results/<scale>/<robot>/falls.csv`.", FALLS),
    "trusted": ("`in_tests` and `held_out`: how far standard deviations can be trusted.", TRUSTED),
    "why": ("`read_why`: the kept table of the trial of why a hit is hidden, `docs/trials/why.csv`.", WHY),
}


def renew() -> None:
    """Write the page of the repository."""
    write_text(CARD, card())


def card() -> str:
    """Return the page as Markdown."""
    parts = [HEAD]
    for name, (text, schema) in FRAMES.items():
        rows = [[f"`{column}`", *described] for column, described in schema.items()]
        header = ["column", "type", "unit", "what it is"]
        parts.append(f"\n## {name}\n{text}\n\n" + markdown_table(header, rows, left=len(header)))
    return "".join(parts)
