"""The table of contact points: a made-up hit, known torques, and errors that follow from them."""

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from csv_files import check_golden, markdown_cells, read_table, write_rows
from made_contacts import pushed
from made_swings import GROUND, RATE_HZ, swinging, unseen

from experiments.evaluation.measure.detection.contact_points import NAMED, NOTHING, _compared
from experiments.evaluation.measure.detection.results import CELLS
from experiments.evaluation.number.frames import CONTACTS
from experiments.evaluation.tables.further.contact_points import write_contacts
from experiments.plan.runs import Run
from experiments.records.collisions import Detected
from experiments.settings.settings import Settings
from mobnet.core.columns import torque_columns
from mobnet.core.errors import DataError
from mobnet.core.recording import Recording
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.detection.contact import ContactLocator
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import ContactNumbers
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.description import RobotDescription

Make = Callable[..., Path]
START, LENGTH, PEAK_N, SEED, DELAY_S = GROUND + 150, 80, 160.0, 101, 0.02
WRONG_N = 400.0  # by which MOB takes the base to be pushed to the left


def write_files(settings: Settings, robot: RobotDescription, folder: Path) -> tuple[list[Run], dict[str, Path]]:
    """Write a recording with one hit, what two methods make of it, and what the detector says."""
    section, layout = settings.evaluation.contact_points, settings.layout
    sensed = swinging(layout, 1)
    force = np.zeros(len(sensed))
    force[START : START + LENGTH] = PEAK_N * np.sin(np.pi * np.arange(LENGTH) / LENGTH)
    q, point = sensed.q[START], next(row for row in robot.points if row.name == "left_knee_front")
    axes, _ = ContactLocator.of(as_plain(settings.contact_point, ContactNumbers), robot, "LL", layout.limb("LL")).place(
        q, point.body
    )
    push = np.zeros((len(sensed), 4))
    push[:, 1:] = -force[:, None] * axes[:, 0]
    push[force > 0.0, 0] = 1 + list(settings.scenarios["collisions"].pushes).index("collision_left_knee_front")
    names = ("recording", "residual", "MOB", "MOB-Net-pushed")
    paths = {name: folder / name / "robot_1" / f"s{SEED}" for name in names}
    meta = {"rate_hz": RATE_HZ}
    truth = unseen(layout, len(sensed), push)
    write_recording(paths["recording"], Recording(sensed, ((0, len(sensed)),), RATE_HZ, {}, truth), layout)
    joints = layout.limbs(section.limbs)
    unit = pushed(robot, q, point.body, point.pos, [-1.0, 0.0, 0.0])[layout.columns(joints)]
    tau = low_pass(force[:, None] * unit, settings.observer.gain_hz, RATE_HZ)
    write_array(paths["residual"], tau, torque_columns(layout, ["tau_ext_lp"], joints), meta)
    wrong = tau.copy()
    wrong[:, joints.index("V2")] += WRONG_N
    write_array(paths["MOB"], wrong, torque_columns(layout, ["tau_ext"], joints), meta)
    known = np.concatenate([tau, np.full(tau.shape, 0.5)], axis=1)
    write_array(paths["MOB-Net-pushed"], known, torque_columns(layout, ["tau_ext", "std"], joints), meta)
    held = "collisions", SEED, "LL", 1, section.detector, section.kind
    said = Detected(*held, 2.0, DELAY_S, None, "mean.LL3", "foot", "front", 90.0)
    write_rows(folder / "detected.csv", [said], Detected)
    runs = [Run("collisions", "robots", name, 0, SEED, paths["recording"], paths["residual"], paths[name])
            for name in ("MOB", "MOB-Net-pushed")]  # fmt: skip
    return runs, {"detected": folder / "detected.csv"}


def counted(table: Path) -> str:
    """Return how many collisions the text says that there are."""
    return next(line[1] for line in markdown_cells(table) if line[0] == "collisions")


@pytest.fixture
def made(make_table: Make, settings: Settings, robot: RobotDescription, tmp_path: Path) -> Path:
    runs, files = write_files(settings, robot, tmp_path)
    pushes = {name: settings.pushes[name] for name in settings.scenarios["collisions"].pushes}
    return make_table("contact_points", runs=runs, detections={"robot_1": files}, pushes=pushes)


def test_errors_are_those_of_the_hit(made: Path) -> None:
    rows = {(row.detector, row.cell, row.quantity): row for row in read_table(made)}
    whole = rows["MOB-Net", "knee front", "error"]
    assert (whole.count, whole.unit) == (1, "cm")
    assert whole.value < 4.0
    assert rows["MOB-Net", "all", "error"].value == whole.value
    assert rows["MOB-Net", "foot front", "error"].count == 0
    parts = [rows["MOB-Net", "all", f"error_{axis}"].value for axis in "xyz"]
    assert np.linalg.norm(parts) == pytest.approx(whole.value, rel=1e-4)
    assert rows["true torque", "all", "error"].value < 4.0
    assert rows["MOB-Net", "all", "angle"].value < 10.0
    # the detector names the foot, whose middle is most of a shank away from the knee
    assert rows["middle of the named link", "all", "error"].value > 30.0
    assert rows["middle of the named link", "all", "force"].value is None


def test_numbers_are_medians_by_what_is_hit(settings: Settings, tmp_path: Path) -> None:
    section = settings.evaluation.contact_points
    made: list[tuple[object, ...]] = []
    for k, title in enumerate((*section.lines, NAMED, NOTHING)):
        said = (None, None, None) if title in (NAMED, NOTHING) else (0.05, -0.1, 7.0)
        # errors of 3, 4 and 12 parts along the axes make 13; the seven hits of a cell have multiples of them
        for cell, n in product(CELLS, range(1, 8)):
            made.append((title, cell, *(0.001 * (k + 1) * n * np.array([3.0, -4.0, 12.0])), *said))
    found = pd.DataFrame(made, columns=list(CONTACTS)).astype({name: kind for name, (kind, _, _) in CONTACTS.items()})
    write_contacts(tmp_path / "contact_points", section, settings.evaluation.statistics, found)
    rows = {(row.detector, row.cell, row.quantity): row for row in read_table(tmp_path / "contact_points.csv")}
    first = rows["MOB", "ankle side", "error"]
    assert (first.value, first.count) == (pytest.approx(5.2), 7)
    # of seven values, those between the least and the largest are the shortest interval of at least 95 %
    assert (first.low, first.high) == (pytest.approx(1.3), pytest.approx(9.1))
    assert rows["MOB-Net", "all", "error_y"].value == pytest.approx(3.2)
    assert (rows["MOB", "all", "force"].value, rows["MOB", "all", "force_size"].value) == (-10.0, 10.0)
    assert rows[NAMED, "all", "spread"].value is None
    check_golden(tmp_path / "contact_points.csv")


def test_wrong_torques_show_in_the_force(made: Path) -> None:
    rows = {(row.detector, row.quantity): row for row in read_table(made) if row.cell == "all"}
    assert rows["MOB", "angle"].value > rows["MOB-Net", "angle"].value + 20.0
    assert rows["MOB", "force_size"].value > rows["MOB-Net", "force_size"].value


def test_the_text_counts_the_collisions(made: Path) -> None:
    assert counted(made) == "1"
    assert [line[0] for line in markdown_cells(made)][-2:] == ["middle of the named link", "middle of the leg"]


def test_weak_and_missed_hits_do_not_count(
    make_table: Make, settings: Settings, robot: RobotDescription, tmp_path: Path
) -> None:
    runs, files = write_files(settings, robot, tmp_path)
    pushes = {name: settings.pushes[name] for name in settings.scenarios["collisions"].pushes}
    given = {"runs": runs, "detections": {"robot_1": files}, "pushes": pushes}
    harder = settings.evaluation.contact_points.model_copy(update={"least_n": PEAK_N + 1.0})
    assert counted(make_table("contact_points", settings=harder, **given)) == "0"
    other = settings.evaluation.contact_points.model_copy(update={"detector": "MOB"})
    assert counted(make_table("contact_points", settings=other, **given)) == "0"


def test_a_line_without_standard_deviations_is_refused(
    make_table: Make, settings: Settings, robot: RobotDescription, tmp_path: Path
) -> None:
    runs, files = write_files(settings, robot, tmp_path)
    pushes = {name: settings.pushes[name] for name in settings.scenarios["collisions"].pushes}
    section = settings.evaluation.contact_points
    lines = {"MOB": section.lines["MOB"].model_copy(update={"std": None})}
    bare = section.model_copy(update={"lines": lines})
    with pytest.raises(DataError, match="MOB gives no standard deviation"):
        make_table("contact_points", settings=bare, runs=runs, detections={"robot_1": files}, pushes=pushes)
    few = [replace(run, estimate=tmp_path / "few") for run in runs]
    meta = {"rate_hz": RATE_HZ}
    rows = np.zeros((len(swinging(settings.layout, 1)), 6))
    write_array(tmp_path / "few", rows, torque_columns(settings.layout, ["tau_ext"], settings.layout.limb("LL")), meta)
    with pytest.raises(DataError, match="are not estimated"):
        make_table("contact_points", runs=few, detections={"robot_1": files}, pushes=pushes)


def test_a_hit_at_the_end_of_its_walk_is_told_by_its_last_row(
    make_table: Make, settings: Settings, robot: RobotDescription, tmp_path: Path
) -> None:
    """The force is asked for some time after the alarm, when the walk may have ended."""
    runs, files = write_files(settings, robot, tmp_path)
    rows = len(swinging(settings.layout, 1))
    section = settings.evaluation.contact_points
    last_s = (rows - 1 - START) / RATE_HZ - DELAY_S
    numbers: list[list[float | None]] = []
    for after_s in (last_s, last_s + 0.001, last_s + 10.0):
        lines = {title: line.model_copy(update={"after_s": None}) for title, line in section.lines.items()}
        late = section.model_copy(update={"after_s": after_s, "lines": lines})
        pushes = {name: settings.pushes[name] for name in settings.scenarios["collisions"].pushes}
        given = {"settings": late, "runs": runs, "detections": {"robot_1": files}, "pushes": pushes}
        table = make_table("contact_points", **given)
        numbers.append([row.value for row in read_table(table)])
    assert numbers[0] == numbers[1] == numbers[2]


def test_a_force_along_the_true_one_has_no_angle_and_one_of_nothing_a_right_one() -> None:
    """Rounding makes the cosine of equal directions more than 1."""
    rng = np.random.default_rng(0)
    for true in rng.normal(size=(200, 3)):
        assert _compared(1.5 * true, true) == (pytest.approx(0.5), pytest.approx(0.0, abs=1e-5))
        assert _compared(-true, true) == (pytest.approx(0.0), pytest.approx(180.0))
    assert _compared(np.zeros(3), np.eye(3)[0]) == (-1.0, pytest.approx(90.0))
    assert _compared(np.zeros(3), np.zeros(3)) == (-1.0, pytest.approx(90.0))
