"""The single collisions and walks behind published tables, of which others can take intervals of their own."""

import gzip
from collections.abc import Iterator, Sequence
from pathlib import Path

from experiments.evaluation.number.frames import read_trials, records_of
from experiments.evaluation.number.rows import Field
from experiments.plan.detection import Detections
from experiments.plan.reactions import Reactions
from experiments.records.collisions import Collision, Detected
from experiments.records.reactions import TRIALS
from mobnet.core.files import atomic_path
from mobnet.core.rows import csv_text, read_rows

FOLDER = "rows"  # of the snapshot
WALKS = "reactions.csv.gz"
COLLISIONS = "collisions.csv.gz"
COLUMNS = (
    "level",
    "scenario",
    "seed",
    "number",
    "leg",
    "hit_link",
    "hit_direction",
    "force_n",
    "impulse_ns",
    "swing_share",
    "detector",
    "kind",
    "ratio",
    "delay_s",
    "perfect_s",
    "link",
    "direction",
)


def write_single_rows(detections: Detections, reactions: Reactions, cases: Sequence[str], out: Path) -> None:
    """Write a row for each collision and detector, and for each walk of the reactions, as compressed CSV.

    Args:
        detections: files of the detectors of the plant and of each robot.
        reactions: files of the trials of each robot.
        cases: cases of the reactions.
        out: folder of the snapshot.

    Raises:
        DataError: a file is missing or damaged.
    """
    _write(out / FOLDER / WALKS, TRIALS, records_of(read_trials(reactions, cases), TRIALS))
    _write(out / FOLDER / COLLISIONS, COLUMNS, list(_collisions(detections)))


def _collisions(detections: Detections) -> Iterator[Sequence[Field]]:
    """Yield what each detector said of each collision, robot by robot."""
    for level, files in detections.items():
        hits = {(row.scenario, row.seed, row.number): row for row in read_rows(files["collisions"], Collision)}
        # What detectors said of one collision stands together: its own numbers, which repeat, take less room so.
        for row in sorted(read_rows(files["detected"], Detected), key=lambda row: (row.scenario, row.seed, row.number)):
            hit = hits[row.scenario, row.seed, row.number]
            struck = hit.link, hit.direction, hit.force_n, hit.impulse_ns, hit.swing_share
            said = row.detector, row.kind, row.ratio, row.delay_s, row.perfect_s, row.link, row.direction
            yield (level, row.scenario, row.seed, row.number, row.leg, *struck, *said)


def _write(path: Path, columns: Sequence[str], rows: Sequence[Sequence[Field]]) -> None:
    """Write rows as compressed CSV, the same bytes for the same rows."""
    with atomic_path(path) as temporary:
        temporary.write_bytes(gzip.compress(csv_text(columns, rows).encode(), mtime=0))
