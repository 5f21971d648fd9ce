"""How large the uncertainty torque is that the networks learn, beside the robot's own."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.number.number import number_text
from experiments.evaluation.tables.layout import OUTSIDE, Line, Table, in_blocks, write_table
from experiments.settings.published import PublishedUncertainty
from experiments.settings.table_columns import UNCERTAINTY
from experiments.settings.tables import Uncertainty
from mobnet.core.columns import RESIDUAL, named
from mobnet.core.joints import JointLayout
from mobnet.core.store import label_of, read_array
from mobnet.settings.networks import NetworkRow

PLANT = "plant"  # head of its column
Record = tuple[str, str, str, float, str, float | None, float | None, str]  # a row of UNCERTAINTY


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
    records: list[Record] = []
    for limb in (name for name in networks if name in layout.groups):  # not those that hold several
        name = networks[limb].data
        joints = layout.limb(limb)
        known = published.std.get(limb, [None] * len(joints))
        owners = {name: (sets[name], settings.ratio.get(limb))}
        owners |= {robot: (own[name], settings.robot_ratio) for robot, own in robots.items() if name in own}
        for owner, (stems, bounds) in owners.items():
            for joint, value, theirs in zip(joints, target_std(stems, joints).tolist(), known, strict=True):
                ratio = None if theirs is None else value / theirs
                unit = layout.unit(joint)
                records.append((limb, joint, owner, value, unit, theirs, ratio, verdict(ratio, bounds)))
    header, lines = text_of(records, list(robots))
    table = Table(UNCERTAINTY, records, header, lines, left=4, note=published.note)
    write_table(table_dir / "uncertainty", table)


def text_of(records: Sequence[Record], robots: Sequence[str]) -> tuple[list[str], list[Line]]:
    """Return head and lines of the text: a line is a joint, and each plant has its size [N m, N] and its ratio [-]."""
    owners = (PLANT, *robots)
    header = ["Limb", "Joint", "Set", "Unit", "Original"]
    for owner in owners:
        header += [owner.replace("_", " "), "ratio"]
    rows: dict[str, dict[str, Record]] = {}
    for record in records:
        owner = record[2] if record[2] in robots else PLANT
        rows.setdefault(record[1], {})[owner] = record
    blocks: dict[str, list[list[str]]] = {}
    for joint, own in rows.items():
        limb, _, name, _, unit, published, *_ = own[PLANT]
        cells: list[str] = []
        for owner in owners:
            cells += size_texts(own[owner]) if owner in own else ("-", "-")
        line = [joint, name.replace("_", " "), unit, number_text(published, 1), *cells]
        blocks.setdefault(limb, []).append(line)
    return header, in_blocks(([limb], lines) for limb, lines in blocks.items())


def size_texts(record: Record) -> tuple[str, str]:
    """Return the texts of a size [N m, N] and of its ratio [-] to the robot's, marked where it is out of bounds."""
    *_, value, _, _, ratio, within = record
    return number_text(value, 1), number_text(ratio) + (OUTSIDE if within == "no" else "")


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
