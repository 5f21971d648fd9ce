"""How large the uncertainty torque is that the networks learn, beside the robot's own."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from experiments.evaluation.number.number import number_text
from experiments.evaluation.tables.layout import OUTSIDE
from experiments.evaluation.tables.look import Row, ShownColumn, TableLook, write_look
from experiments.settings.published import PublishedUncertainty
from experiments.settings.table_columns import UNCERTAINTY
from experiments.settings.tables import Uncertainty
from mobnet.core.columns import RESIDUAL, named
from mobnet.core.joints import JointLayout
from mobnet.core.store import label_of, read_array
from mobnet.settings.networks import NetworkRow

PLANT = "plant"  # head of the column of its plant


def uncertainty(
    settings: Uncertainty,
    networks: Mapping[str, NetworkRow],
    layout: JointLayout,
    published: PublishedUncertainty,
    sets: Mapping[str, Sequence[Path]],
    robots: Mapping[str, Mapping[str, Sequence[Path]]],
    table_dir: Path,
) -> None:
    """Write uncertainty.csv, .tex and .md: standard deviation of the learning target of each joint [N m], V1..V3 [N].

    `sets` has the residuals of each training set, `robots` those of each surrogate robot's own sets of the same names.
    """
    rows: list[dict[str, object]] = []
    for limb in (name for name in networks if name in layout.groups):  # not those that hold several
        data = networks[limb].data
        joints = layout.limb(limb)
        published_std = published.std.get(limb, [None] * len(joints))
        plants = {PLANT: (data, sets[data], settings.ratio.get(limb))}
        for robot, sets_of_robot in robots.items():
            if data in sets_of_robot:
                plants[robot] = (robot, sets_of_robot[data], settings.robot_ratio)
        for plant, (name, stems, bounds) in plants.items():
            for joint, value, printed in zip(joints, target_std(stems, joints).tolist(), published_std, strict=True):
                ratio = None if printed is None else value / printed
                place = {"limb": limb, "joint": joint, "data": data, "plant": plant, "set": name}
                number = {"value": value, "unit": layout.unit(joint), "published": printed, "ratio": ratio}
                rows.append({**place, **number, "within": verdict(ratio, bounds)})
    table = pd.DataFrame(rows).astype({"published": float, "ratio": float})
    write_look(table_dir / "uncertainty", table, UNCERTAINTY, look_at([PLANT, *robots], published.note))


def look_at(plants: Sequence[str], note: str) -> TableLook:
    """Return what a reader sees: a line is a joint, and each plant has its size [N m, N] and its ratio [-]."""
    shown = [ShownColumn("Original", {"plant": PLANT}, text=lambda row: number_text(row["published"], 1))]
    for plant in plants:
        shown.append(ShownColumn(plant.replace("_", " "), {"plant": plant}, digits=1))
        shown.append(ShownColumn("ratio", {"plant": plant}, text=_ratio_text))
    labels = {"limb": "Limb", "joint": "Joint", "data": "Set", "unit": "Unit"}
    return TableLook(labels, shown, blocks=("limb",), note=note)


def _ratio_text(row: Row) -> str:
    """Return the ratio [-] of a size to the robot's, marked where it is out of bounds."""
    return number_text(row["ratio"]) + (OUTSIDE if row["within"] == "no" else "")


def target_std(stems: Sequence[Path], joints: Sequence[str]) -> NDArray[np.float64]:
    """Return the standard deviation of r less the label over all samples of residual files (n,) [N m], V1..V3 [N]."""
    count = 0
    mean = np.zeros(len(joints))
    spread = np.zeros(len(joints))
    for stem in stems:
        array = read_array(stem, [*named(RESIDUAL, joints), *named(label_of(stem), joints)])[0].astype(np.float64)
        target = array[:, : len(joints)] - array[:, len(joints) :]
        before = count
        count = count + len(target)
        step = target.mean(axis=0) - mean
        mean += step * len(target) / count  # the pairwise update of Chan et al.: one file in memory, no cancellation
        spread += target.var(axis=0) * len(target) + step**2 * before * len(target) / count
    return np.sqrt(spread / count)


def verdict(ratio: float | None, bounds: Sequence[float] | None) -> str:
    """Return whether a ratio [-] lies in its closed bounds [-]: `yes`, `no`, or nothing where either is missing."""
    if ratio is None or bounds is None:
        return ""
    return "yes" if bounds[0] <= ratio <= bounds[1] else "no"
