"""How far the labels of the foot sensors are from the truth, as read and without the inertia below the sensors."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.tables.look import ShownColumn, TableLook, write_look
from experiments.settings.table_columns import LABEL_ERROR
from experiments.settings.tables import LabelError
from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL_LP, FEET, foot_of, named
from mobnet.core.joints import JointLayout
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import read_array
from mobnet.estimation.label import foot_label
from mobnet.estimation.observe import read_wrenches
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.settings.methods import ObserverSettings

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
    by_place: dict[tuple[str, str, str], Array] = {}
    for owner, (recording, residual) in walks.items():
        read = read_sensed(recording, layout)
        wrenches = read_wrenches(recording, nominal.robot)
        truth = read_array(residual, named(EXTERNAL_LP, joints))[0]
        air = read.sensed.swing[:, foot] > 0
        for label, plates in LABELS.items():
            torque = foot_label(nominal, read, wrenches, observer.gain_hz, plates=plates)
            square = (torque[:, columns] - truth) ** 2
            for phase, rows in zip(PHASES, (np.ones_like(air), air, ~air), strict=True):
                by_place[owner, label, phase] = np.sqrt(square[rows].mean(axis=0))
    errors: list[tuple[str, str, str, str, float]] = []
    for place, values in by_place.items():
        errors += [(*place, joint, value) for joint, value in with_mean(joints, values)]
    rows = pd.DataFrame(errors, columns=["robot", "label", "phase", "joint", "value"]).assign(unit="N m")
    shown = [ShownColumn(joint, {"phase": WALK, "joint": joint}) for joint in (*joints, AVERAGE)]
    shown += [ShownColumn(f"{AVERAGE}, {phase}", {"phase": phase, "joint": AVERAGE}) for phase in (SWING, GROUND)]
    look = TableLook({"robot": "Robot", "label": "Label"}, shown, blocks=("robot",))
    write_look(table_dir / "label_error", rows, LABEL_ERROR, look)


def with_mean(joints: Sequence[str], values: Array) -> list[tuple[str, float]]:
    """Return joints with their values (n,), and their mean."""
    return [*zip(joints, values.tolist(), strict=True), (AVERAGE, float(values.mean()))]
