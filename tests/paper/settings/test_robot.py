"""A robot's table: every fault is one line with place, value and accepted values, and all are told at once."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from mobnet.core.errors import ConfigError
from mobnet.formats.loading import load_section
from mobnet.formats.reading import read_yaml
from mobnet.formats.robot import RobotTable

ROOT = Path(__file__).parents[3]
TOCABI, ARM = ROOT / "configs" / "robots" / "tocabi.yaml", ROOT / "tests" / "data" / "arm.yaml"
Break = Callable[[dict[str, Any]], object]


def load_broken(tmp_path: Path, source: Path, *breaks: Break) -> RobotTable:
    """Return a table after changes of its values."""
    table = read_yaml(source)
    for change in breaks:
        change(table)
    path = tmp_path / "robot.yaml"
    path.write_text(yaml.dump(table, Dumper=yaml.CSafeDumper, sort_keys=False))
    return load_section(path, RobotTable)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.update(base="flying"), "base: 'flying' is not accepted; accepted: 'fixed', 'floating'"),
        (lambda t: t.update(base="fixed"), "order.virtual: 6 joints are not accepted; accepted: 0 of a fixed base"),
        (lambda t: t["order"].pop("virtual"), "order.virtual: 0 joints are not .*: 6 of a floating base"),
        (lambda t: t["bodies"][3].update(parent="nowhere"), "bodies.3.parent: parent of L_Thigh_Link: 'nowhere' is"),
        (lambda t: t["bodies"][1].update(parent="world"), "parent of L_HipRoll_Link: 'world' is not .*: base_link"),
        (lambda t: t["bodies"].insert(1, t["bodies"].pop(8)), "parent of R_HipCenter_Link: .*; accepted: .*L_Ankle"),
        (lambda t: t["bodies"][3].update(mass=0.0), "bodies.3.mass: 0.0 is not accepted; accepted: a number above 0"),
        (lambda t: t["bodies"][3].update(quat=[1.0, 0.1, 0.0, 0.0]), "bodies.3.quat: .* length 1.00499 is not .*:"),
        (lambda t: t["bodies"][3].update(inertia=[0.1, 0.1, 0.3, 0.0, 0.0, 0.0]), "3.inertia: .* moments 0.1, 0.1,"),
        (lambda t: t["bodies"][3].update(inertia=[0.1, 0.1, 0.1, 0.2, 0.0, 0.0]), "accepted: all above 0 and none"),
        (lambda t: t["bodies"][3].update(pos=[0.0, 0.0]), "bodies.3.pos"),
        (lambda t: t["joints"][0].update(body="L_Wing"), "joints.0.body: 'L_Wing' is not accepted; accepted:"),
        (lambda t: t["joints"][0].update(body="base_link"), "joints.0.body: the base 'base_link' is not .*: a body"),
        (lambda t: t["joints"][0].update(axis=[0.0, 1.0, 1.0]), "joints.0.axis: .* of length 1.41421 is not .*:"),
        (lambda t: t["joints"][0].update(range=[1.0, -1.0]), "joints.0.range: .* is not .*: two numbers"),
        (lambda t: t["joints"].reverse(), "joints: joint 0, 'RA8', is not .*: 'LL1', by `order.actuated`"),
        (lambda t: t["joints"].pop(), "joints: joint 32, None, is not accepted; accepted: 'RA8'"),
        (lambda t: t["joints"].pop(10), "joints: joint 10, 'RL6', is not accepted; accepted: 'RL5'"),
        (lambda t: t["groups"]["W"].append("W4"), "groups.W.3: joint: 'W4' is not accepted; accepted: "),
        (lambda t: t["groups"]["W"].append("LL1"), "groups: 'LL1' 2 times is not accepted; accepted: each name once"),
        (lambda t: t["networks"]["W"].update(Q=["tail"]), "networks.W.Q.0: limb: 'tail' is not accepted; accepted: LA"),
        (lambda t: t["posture"]["N"].update(angle_rad=[0.0]), "posture.N.angle_rad: 1 numbers is not .*: 2"),
        (lambda t: t["posture"].update(T=t["posture"]["N"]), "posture.T: limb: 'T' is not accepted"),
        (lambda t: t["hands"].update(left="L_Hook"), "hands.left: body: 'L_Hook' is not .*: L_Foot_Link"),
        (lambda t: t["feet"].update(middle=t["feet"]["left"]), "feet.middle"),
        (lambda t: t["feet"]["left"].update(limb="LX"), "feet.left.limb: 'LX' is not accepted"),
        (lambda t: t.pop("sole"), "feet: `feet` without `sole`"),
        (lambda t: t["imu"].update(body="Head_Link"), "imu.body: body: 'Head_Link' is not accepted; accepted: base"),
        (lambda t: t["shapes"][0].update(tone="pink"), "shapes.0.tone: 'pink' is not accepted; accepted: accent"),
        (lambda t: t["shapes"][0].update(size=[0.1]), "shapes.0: box pelvis with 1 sizes is not accepted; accepted: 3"),
        (lambda t: t["shapes"][2].update(type="box"), "shapes.2: box left_hip with `segment` .*: capsule"),
        (lambda t: t["shapes"][2].update(body="L_Foot_Link_"), "shapes.2.body: 'L_Foot_Link_' is not accepted"),
        (lambda t: t["points"][1].update(name="torso"), "points: 'torso' 2 times is not .*: each name once"),
        (lambda t: t["points"][1].update(name="right_knee_front"), "points: 'right_knee_front' 2 times"),
        (lambda t: t["totals"].update(mass=95.7), "totals.mass: 95.7 is not accepted; accepted: 95.621910"),
        (lambda t: t["totals"].update(dof=40), "totals.dof: 40 is not accepted; accepted: 39, by the rows"),
        (lambda t: t.update(wings=2), "wings: key: 'wings' is not accepted; accepted: joints, .*, bodies"),
        (lambda t: t.pop("order"), "order: key is missing"),
    ],
)  # fmt: skip
def test_a_fault_is_one_line_with_place_value_and_accepted(tmp_path: Path, change: Break, message: str) -> None:
    with pytest.raises(ConfigError, match=rf"(?m)^{tmp_path / 'robot.yaml'}:\d+: .*{message}"):
        load_broken(tmp_path, TOCABI, change)


def test_a_mirror_image_needs_a_body(tmp_path: Path) -> None:
    def add(table: dict[str, Any]) -> None:
        table["bodies"][2]["name"] = table["joints"][1]["body"] = "L_Link"
        table["points"] = [{"name": "left_hand", "body": "L_Link"}]

    with pytest.raises(ConfigError, match=r"points.0.body: body of the mirror image: 'R_Link' is not accepted"):
        load_broken(tmp_path, ARM, add)


def test_all_faults_of_a_table_are_told_at_once(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as caught:
        load_broken(
            tmp_path,
            TOCABI,
            lambda t: t["hands"].update(left="L_Hook"),
            lambda t: t["groups"]["W"].append("W4"),
            lambda t: t["imu"].update(body="Head_Link"),
        )
    places = [line.split(": ")[1] for line in str(caught.value).splitlines()]
    assert sorted(places) == ["groups.W.3", "hands.left", "imu.body"]


def test_text_of_a_table_is_short_and_changes_with_every_figure(tmp_path: Path) -> None:
    """The text is a parameter of every rule that takes the robot, so that a changed figure reruns it."""
    table = load_section(TOCABI, RobotTable)
    assert repr(table) == repr(load_broken(tmp_path, TOCABI)) == repr(RobotTable.model_validate(table.model_dump()))
    assert len(repr(table)) < 80
    changes: list[Break] = [
        lambda t: t["bodies"][7].update(com=[0.0162, 8.1e-05, -0.1209]),
        lambda t: t["points"].pop(),
        lambda t: t["posture"]["LA"]["damping_nms_rad"].__setitem__(0, 10.001),
        lambda t: t["totals"].update(height_m=1.81),
    ]
    texts = [repr(load_broken(tmp_path, TOCABI, change)) for change in changes]
    assert len({repr(table), *texts}) == 1 + len(changes)


def test_a_table_needs_bodies_joints_and_groups_alone() -> None:
    layout = load_section(ARM, RobotTable).layout
    assert (layout.nq, layout.nv, layout.nu, layout.names, dict(layout.legs)) == (2, 2, 2, ("J1", "J2"), {})
    assert load_section(TOCABI, RobotTable).layout.legs == {"left": "LL", "right": "RL"}
