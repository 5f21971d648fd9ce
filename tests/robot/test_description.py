"""The table of figures: what it holds, and that a table that does not fit itself is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from mobnet.core.errors import ConfigError
from mobnet.robot.description import RobotDescription, load_robot

TABLE = Path(__file__).parents[2] / "configs" / "robots" / "tocabi.yaml"


def test_totals_are_the_published_ones(robot: RobotDescription) -> None:
    totals = yaml.safe_load(TABLE.read_text())["totals"]
    assert robot.mass == pytest.approx(totals["mass"], rel=1e-9)
    assert len(robot.bodies) == totals["bodies"]
    assert (robot.layout.nu, robot.layout.nv) == (totals["actuated_joints"], totals["dof"])


def test_joints_stand_in_motor_order(robot: RobotDescription) -> None:
    assert tuple(joint.id for joint in robot.joints) == robot.layout.actuated
    assert robot.torque_limits.shape == robot.armature.shape == (robot.layout.nu,)


def test_left_and_right_weigh_the_same(robot: RobotDescription) -> None:
    mass = {body.name: body.mass for body in robot.bodies}
    assert all(mass[name] == mass[name.replace("L_", "R_", 1)] for name in mass if name.startswith("L_"))


def test_link_inertia_obeys_the_triangle_inequality(robot: RobotDescription) -> None:
    for body in robot.bodies:
        xx, yy, zz, xy, xz, yz = body.inertia
        principal = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        assert principal[0] > 0, body.name
        assert principal[2] <= 1.001 * (principal[0] + principal[1]), body.name


def test_unknown_foot_is_named(robot: RobotDescription) -> None:
    with pytest.raises(ConfigError, match="'middle' is not accepted; accepted: left, right"):
        robot.foot("middle")


@pytest.mark.parametrize(
    ("break_it", "message"),
    [
        (lambda table: table["bodies"][1].update(parent="nowhere"), "'nowhere' is not accepted"),
        (lambda table: table["joints"][0].update(body="L_Wing"), "'L_Wing' is not accepted"),
        (lambda table: table["joints"].reverse(), "joints stand in the order"),
        (lambda table: table["bodies"].insert(1, table["bodies"].pop(8)), "joints stand in the order"),
        (lambda table: table["hands"].update(left="L_Hook"), "left hand: 'L_Hook' is not accepted"),
    ],
)
def test_table_that_does_not_fit_itself_is_refused(tmp_path: Path, break_it, message: str) -> None:
    table = yaml.safe_load(TABLE.read_text())
    break_it(table)
    path = tmp_path / "robot.yaml"
    path.write_text(yaml.safe_dump(table))
    with pytest.raises(ConfigError, match=message):
        load_robot(path)
