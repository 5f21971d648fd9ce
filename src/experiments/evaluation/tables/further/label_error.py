"""How far the labels of the foot sensors are from the truth, as read and without the inertia below the sensors."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from experiments.evaluation.number.number import number_text
from experiments.evaluation.tables.layout import Table, in_blocks, write_table
from experiments.settings.tables import LabelError
from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL_LP, FEET, LABEL_ERROR, foot_of, named
from mobnet.core.joints import JointLayout
from mobnet.core.recording import read_sensed
from mobnet.core.store import read_array
from mobnet.estimation.label import foot_label
from mobnet.estimation.observe import read_wrenches
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.robot import RobotTable

LABELS = {"as read": False, "without the plate": True}  # label -> whether the plate's inertia is taken off
WALK, SWING, GROUND = PHASES = ("walk", "swing", "ground")
AVERAGE = "avg"


def label_error(
    settings: LabelError,
    robot: RobotTable,
    observer: ObserverSettings,
    layout: JointLayout,
    walks: Mapping[str, tuple[Path, Path]],
    table_dir: Path,
) -> None:
    """Write label_error.csv, .tex and .md: RMSE of the labels of a leg's joints [N m] in a walk of each robot.

    `walks` has a recording of each robot, with labels by foot sensors, and its residual.
    """
    nominal = NominalModel(describe(robot))
    joints = layout.limb(settings.leg)
    columns = [layout.names.index(joint) for joint in joints]
    foot = FEET.index(foot_of(layout, joints[0]))
    found: dict[tuple[str, str, str], Array] = {}
    for owner, (recording, residual) in walks.items():
        read = read_sensed(recording, layout)
        wrenches = read_wrenches(recording, nominal.robot)
        truth = read_array(residual, named(EXTERNAL_LP, joints))[0]
        air = read.sensed.swing[:, foot] > 0
        for label, plates in LABELS.items():
            torque = foot_label(nominal, read, wrenches, observer.gain_hz, plates=plates)
            square = (torque[:, columns] - truth) ** 2
            for phase, rows in zip(PHASES, (np.ones_like(air), air, ~air), strict=True):
                found[owner, label, phase] = np.sqrt(square[rows].mean(axis=0))
    records: list[tuple[str, str, str, str, float, str]] = []
    for key, values in found.items():
        records += [(*key, joint, value, "N m") for joint, value in with_mean(joints, values)]
    header = ["Robot", "Label", *joints, AVERAGE, *(f"{AVERAGE}, {phase}" for phase in (SWING, GROUND))]
    blocks: list[tuple[list[str], list[list[str]]]] = []
    for owner in walks:
        lines = [line(found, owner, label) for label in LABELS]
        blocks.append(([owner.replace("_", " ")], lines))
    write_table(table_dir / "label_error", Table(LABEL_ERROR, records, header, in_blocks(blocks), left=2))


def with_mean(joints: Sequence[str], values: Array) -> list[tuple[str, float]]:
    """Return joints with their values (n,), and their mean."""
    return [*zip(joints, values.tolist(), strict=True), (AVERAGE, float(values.mean()))]


def line(found: Mapping[tuple[str, str, str], Array], owner: str, label: str) -> list[str]:
    """Return the cells of a robot's label: errors of the joints in the walk, and means of it and its phases [N m]."""
    means = [float(found[owner, label, phase].mean()) for phase in PHASES]
    return [label, *(number_text(value) for value in (*found[owner, label, WALK].tolist(), *means))]
