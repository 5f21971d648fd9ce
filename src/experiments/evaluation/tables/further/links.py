"""Which link a collision hits and from where, as detectors name it at their alarm: a confusion matrix."""

from pathlib import Path

from experiments.evaluation.measure.detection.results import CELLS, hits_of, with_all
from experiments.evaluation.number.laws import counted, measured, share
from experiments.evaluation.tables.look import ShownColumn, TableLook, interval, write_look
from experiments.plan.detection import Detections
from experiments.settings.detection_tables import Links
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import DETECTION
from mobnet.settings.detection import Detection

PLACE = ["level", "detector", "leg", "kind"]


def links(
    settings: Links, detection: Detection, statistics: Statistics, detections: Detections, table_dir: Path
) -> None:
    """Write links.csv, .tex and .md: collisions that are found, by what they hit and what the detector names.

    The last columns are the shares of those whose link, and whose link and direction, it names [-].
    """
    hits = with_all(hits_of(settings, detections, detection.collisions, [settings.kind]))
    hits["right_link"] = hits["named_link"] == hits["link"]
    hits["right_cell"] = hits["named"] == hits["link"] + " " + hits["direction"]
    laws = {f"named {cell}": counted("named", cell) for cell in CELLS}
    laws |= {name: share(name, statistics) for name in ("right_link", "right_cell")}
    rows = measured(hits, PLACE, laws, each="cell", of="found")
    shown = [ShownColumn(cell, {"quantity": f"named {cell}"}, digits=0) for cell in CELLS]
    shown += [ShownColumn("link", {"quantity": "right_link"}), ShownColumn("link and side", {"quantity": "right_cell"})]
    shown.append(ShownColumn(f"{statistics.confidence:.0%} (link)", {"quantity": "right_link"}, text=interval))
    labels = {"level": "Level", "detector": "Detector", "cell": "Hit"}
    write_look(table_dir / "links", rows, DETECTION, TableLook(labels, shown, blocks=("level", "detector")))
