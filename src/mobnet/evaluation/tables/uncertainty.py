"""How large the uncertainty torque is that the networks learn, beside the robot's own."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.config import load_layout, read_yaml
from mobnet.core.errors import ConfigError
from mobnet.core.files import write_text
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.tables.layout import RULE, Line, markdown_table, number, tex_escape, text_table

log = logging.getLogger(__name__)

RESIDUAL, TRUTH = "r.", "tau_ext_lp."  # columns of a residual file


@dataclass(frozen=True)
class Size:
    """Size of one joint's uncertainty torque: a row of uncertainty.csv.

    Attributes:
        limb: limb of section 4.1.
        joint: joint.
        set: training set that the limb's network learns from.
        value: standard deviation of r - tau_ext_lp, the target of section 4.2.3 [unit].
        unit: unit of the number.
        published: the robot's standard deviation [unit]; None where it is not known.
        ratio: ours over the robot's [-]; None where that is not known.
        within: `yes` or `no`: the ratio lies within the bounds; empty where none are set.
    """

    limb: str
    joint: str
    set: str
    value: float
    unit: str
    published: float | None
    ratio: float | None
    within: str


def uncertainty(config: Mapping[str, Any], sets: Mapping[str, Sequence[str]], out_dir: Path) -> None:
    """Write uncertainty.csv, .tex and .md: standard deviation of the learning target of each joint [N m], V1..V3 [N].

    Args:
        config: resolved configuration: `robot`, `published`, `networks`, which name the training set of each limb, and
            `evaluation.uncertainty.ratio`, limb -> accepted ratios [-] to the robot's.
        sets: name of a training set -> stems of its residuals.
        out_dir: gets the three files.

    Raises:
        DataError: a file or a column is missing.
        ConfigError: the robot's numbers do not fit its joints.
    """
    layout = load_layout(Path(config["robot"]))
    settings, entry = config["evaluation"]["uncertainty"], read_sizes(Path(config["published"]), layout)
    rows: list[Size] = []
    limbs = [name for name in config["networks"] if name in layout.groups]  # not those that hold several
    for limb in limbs:
        name, joints = config["networks"][limb]["data"], layout.limb(limb)
        values = target_std(list(map(Path, sets[name])), joints)
        known = entry["std"].get(limb, [None] * len(joints))
        for joint, value, theirs in zip(joints, values.tolist(), known, strict=True):
            ratio = None if theirs is None else value / theirs
            within = verdict(ratio, settings["ratio"].get(limb))
            rows.append(Size(limb, joint, name, value, layout.unit(joint), theirs, ratio, within))
    header = ["Limb", "Joint", "Set", "Unit", "Simulated", "Robot", "Ratio", "In bounds"]
    lines, note = size_lines(rows), entry["note"]
    write_rows(out_dir / "uncertainty.csv", Size, rows)
    write_text(out_dir / "uncertainty.tex", text_table("llllrrrl", header, lines) + note_tex(note))
    write_text(out_dir / "uncertainty.md", markdown_table(header, lines, left=4) + f"\n{note}\n")
    log.info("%s: %d joints", out_dir / "uncertainty.csv", len(rows))


def read_sizes(path: Path, layout: JointLayout) -> dict[str, Any]:
    """Return the robot's standard deviations, limb -> one a joint [N m], V1..V3 [N], and the note that goes with them.

    Raises:
        ConfigError: a limb is unknown, or has not one number for each joint.
    """
    entry = read_yaml(path)["uncertainty"]
    for limb, numbers in entry["std"].items():
        joints = layout.limb(limb)
        if len(numbers) != len(joints):
            raise ConfigError(
                f"{path}: uncertainty.std.{limb}: {len(numbers)} numbers for {len(joints)} joints ({', '.join(joints)})"
            )
    return entry


def target_std(stems: Sequence[Path], joints: Sequence[str]) -> NDArray[np.float64]:
    """Return the standard deviation of r - tau_ext_lp over all samples of residual files (n,) [N m], V1..V3 [N].

    Raises:
        DataError: a file or a column is missing.
    """
    names = [prefix + joint for prefix in (RESIDUAL, TRUTH) for joint in joints]
    count, mean, spread = 0, np.zeros(len(joints)), np.zeros(len(joints))
    for stem in stems:
        array = read_array(stem, names)[0].astype(np.float64)
        target = array[:, : len(joints)] - array[:, len(joints) :]
        before, count = count, count + len(target)
        step = target.mean(axis=0) - mean
        mean += step * len(target) / count  # the pairwise update of Chan et al.: one file in memory, no cancellation
        spread += target.var(axis=0) * len(target) + step**2 * before * len(target) / count
    return np.sqrt(spread / count)


def verdict(ratio: float | None, bounds: Sequence[float] | None) -> str:
    """Return whether a ratio [-] lies in its closed bounds [-]: `yes`, `no`, or nothing where either is missing."""
    if ratio is None or bounds is None:
        return ""
    return "yes" if bounds[0] <= ratio <= bounds[1] else "no"


def size_lines(rows: Sequence[Size]) -> list[Line]:
    """Return the rows of text, a rule between limbs."""
    lines: list[Line] = []
    before = ""
    for row in rows:
        first = row.limb != before
        if first and before:
            lines.append(RULE)
        before = row.limb
        names = [row.limb if first else "", row.joint, row.set if first else "", row.unit]
        lines.append([*names, number(row.value, 1), number(row.published, 1), number(row.ratio), row.within])
    return lines


def note_tex(note: str) -> str:
    """Return a note to stand under a table."""
    return rf"\par\smallskip\parbox{{\linewidth}}{{\raggedright {tex_escape(note)}}}" + "\n"
