"""Table 13: thresholds of a leg's joints by the paper's rule, for each detector."""

from collections import defaultdict
from collections.abc import Sequence
from itertools import product
from pathlib import Path

from experiments.evaluation.measure.detection.results import Detections, owners, rows_of
from experiments.evaluation.number.number import number_text, published_row
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import OUTSIDE, Table, in_blocks, write_table
from experiments.settings.detection_tables import ThresholdTable
from experiments.settings.published import PublishedTable
from mobnet.core.columns import DETECTION
from mobnet.core.detections import Threshold
from mobnet.core.joints import JointLayout
from mobnet.detection.signals import MEAN, RATIO, STD

THRESHOLD = "threshold_nm"  # place of the paper's numbers
QUANTITY = "threshold"


def table_13(
    settings: ThresholdTable, layout: JointLayout, published: PublishedTable, detections: Detections, table_dir: Path
) -> None:
    """Write table_13.csv, .tex and .md: thresholds, means over the robots of a level with the least and the most.

    They are torques [N m], those of MOB-Net-pushed-ratio without unit [-]. Below those of one detector is their ratio to the
    paper's. The CSV has the thresholds of all detectors of both legs
    and by all rules.
    """
    rows: list[tuple[Field, ...]] = []
    blocks: list[tuple[list[str], list[list[str]]]] = []
    joints = layout.limb(settings.leg)
    for level in settings.levels:
        names = owners(detections, level, settings.levels)
        found: dict[tuple[str, ...], list[Threshold]] = defaultdict(list)
        for row in rows_of(detections, names, "thresholds", Threshold):
            found[row.detector, row.leg, row.kind, f"{row.signal} {row.phase}"].append(row)
        means: dict[tuple[str, ...], float] = {}
        for key, own in found.items():
            values = [row.value for row in own]
            means[key] = sum(values) / len(values)
            paper = published_row(published, THRESHOLD, key[0]).get(own[0].signal.partition(".")[2])
            is_shown = key[1:3] == (settings.leg, settings.kind)
            ends = min(values), max(values), len(values)
            rows.append((level, *key, QUANTITY, means[key], *ends, own[0].unit, paper if is_shown else None))
        lines: list[list[str]] = []
        for name in settings.detectors:
            own = []
            for joint, kind in product(joints, (MEAN, STD, RATIO)):
                key = name, settings.leg, settings.kind, f"{kind}.{joint} 1"
                if key in means:
                    own.append(means[key])
            lines.append([name, "ours", *(number_text(value) for value in own)])
            if printed := published_row(published, THRESHOLD, name):
                lines.append(["", "original", *(number_text(printed[joint]) for joint in joints)])
            if printed and name == settings.sized:
                sizes = [ours / theirs for ours, joint in zip(own, joints, strict=True) if (theirs := printed[joint])]
                lines.append(["", "ratio", *(ratio_text(size, settings.ratio) for size in sizes)])
        blocks.append(([level.replace("_", " ")], lines))
    header = ["Level", "Detector", "", *(f"{joint} [N m]" for joint in joints)]
    write_table(table_dir / "table_13", Table(DETECTION, rows, header, in_blocks(blocks), left=3))


def ratio_text(ratio: float, bounds: Sequence[float]) -> str:
    """Return the text of a ratio [-], marked where it lies outside of its closed bounds."""
    return number_text(ratio) + ("" if bounds[0] <= ratio <= bounds[1] else OUTSIDE)
