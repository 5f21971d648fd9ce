"""The smallest force that detectors find, by what is hit from where."""

from pathlib import Path

from experiments.evaluation.measure.detection.results import CELLS, force_of, force_text, hits_of
from experiments.evaluation.number.laws import measured
from experiments.evaluation.tables.look import Row, ShownColumn, TableLook, write_look
from experiments.plan.detection import Detections
from experiments.settings.detection_tables import SmallestForce
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import DETECTION
from mobnet.settings.detection import Detection


def smallest_force(
    settings: SmallestForce, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:
    """Write smallest_force.csv, .tex and .md: the largest force [N] that a collision must have to be found.

    It is that of which the share of section `smallest_force` is found, by detector, rule of thresholds and cell.
    """
    hits = hits_of(settings, detections, detection.sweep, settings.kinds)
    laws = {"smallest_force": lambda same: force_of(same, settings, statistics)}
    rows = measured(hits, ["level", "kind", "detector", "leg"], laws, each="cell")
    shown = [ShownColumn(f"{cell} [N]", {"cell": cell}, text=_force_text) for cell in CELLS]
    labels = {"level": "Level", "kind": "Rule", "detector": "Detector"}
    write_look(table_dir / "smallest_force", rows, DETECTION, TableLook(labels, shown, ("level", "kind"), nested=True))


def _force_text(row: Row) -> str:
    return force_text(row["value"], row["low"], row["high"])
