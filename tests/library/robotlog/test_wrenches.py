"""External wrenches at a point of a limb: exact where the joints tell them, bounded and said where they do not."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from mobnet.core.errors import ConfigError
from mobnet.core.estimator import Estimate
from mobnet.core.store import read_array
from mobnet.formats.loading import load_section
from mobnet.formats.plain import as_plain
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.robot.point_jacobian import point_jacobian
from mobnet.robot.wrench import carrier_of
from mobnet.robotlog.observe import main as observe
from mobnet.robotlog.wrenches import WrenchNumbers, place_of, wrench_lines, wrenches_of

ROWS = 400
MIDDLE, SPREAD = np.array([0.0, -0.6, 0.0, -1.8, 0.0, 1.8, 0.0]), 0.5  # poses of the Panda far from singular ones [rad]
LARGE = np.array([60.0, 60.0, 60.0, 8.0, 8.0, 8.0])  # [N], [N m]


@pytest.fixture(scope="module")
def panda():
    return NominalModel(describe(load_section(Path("configs/robots/panda.yaml"), RobotTable)))


@pytest.fixture(scope="module")
def planar(arm):
    return NominalModel(arm)


@pytest.fixture
def numbers(settings):
    return as_plain(settings.robotlog.wrench, WrenchNumbers)


def posed(rows=ROWS, seed=0):
    """Return poses of the Panda (rows, 7) and a random generator."""
    rng = np.random.default_rng(seed)
    return MIDDLE + SPREAD * rng.uniform(-1, 1, (rows, 7)), rng


def torques(nominal, place, q, wrench):
    """Return J^T F of wrenches (T, 6) in world axes at a place, for its joints."""
    columns = [nominal.robot.layout.actuated.index(joint) for joint in place.joints]
    jacobian = point_jacobian(nominal, place.body, place.pos, q)[:, :, columns]
    return np.einsum("tij,ti->tj", jacobian, wrench)


@pytest.mark.parametrize(
    ("which", "body"), [("panda", "panda_link7"), ("nominal", "L_Wrist2_Link"), ("planar", "lower")]
)
def test_the_jacobian_is_that_of_pinocchio(which, body, request, random_poses):
    nominal, pos = request.getfixturevalue(which), np.array([0.02, -0.1, 0.2])
    q = random_poses(nominal, 5)
    joint, placement = carrier_of(nominal.robot, body)
    frame = pin.Frame("point", nominal.model.getJointId(joint), placement * pin.SE3(np.eye(3), pos), pin.OP_FRAME)
    model = nominal.model.copy()
    data, number = (model.addFrame(frame), model.createData())[1], model.getFrameId("point")
    found = point_jacobian(nominal, body, tuple(pos), q)
    for row, own in zip(q, found, strict=True):
        pin.computeJointJacobians(model, data, nominal.positions(row))
        pin.updateFramePlacements(model, data)
        wanted = pin.getFrameJacobian(model, data, number, pin.LOCAL_WORLD_ALIGNED)
        np.testing.assert_allclose(own, wanted[:, len(nominal.robot.layout.virtual) :], atol=1e-12)


@pytest.fixture
def random_poses():
    def make(nominal, rows):
        rng = np.random.default_rng(3)
        q = rng.uniform(-1, 1, (rows, nominal.model.nq))
        if nominal.robot.floating:
            q[:, 3:7] /= np.linalg.norm(q[:, 3:7], axis=1)[:, None]
        return q

    return make


def test_a_wrench_on_the_hand_of_an_arm_is_told_to_a_percent(panda, numbers):
    q, rng = posed()
    place, true = place_of(panda, "hand"), LARGE * rng.uniform(-1, 1, (ROWS, 6))
    assert (place.body, place.moved_by) == ("panda_link7", 7)
    found = wrenches_of(panda, place, q, Estimate(torques(panda, place, q, true)), numbers)
    assert found.told.min() > 0.99
    assert found.std is None
    assert (np.abs(found.mean - true) <= 0.01 * LARGE).all()


def test_near_a_singular_pose_a_wrench_is_bounded_and_said_not_to_be_told(panda, numbers):
    # Along the stretched arm, whose wrist is straight, no joint feels a force.
    q = np.tile([0.0, 0.0, 0.0, -1e-4, 0.0, 1e-4, 0.0], (ROWS, 1))
    rng, place = np.random.default_rng(1), place_of(panda, "hand")
    errors = numbers.torque_error * panda.robot.torque_limits * rng.normal(size=(ROWS, 7))
    found = wrenches_of(panda, place, q, Estimate(errors), numbers)
    plain = np.linalg.pinv(point_jacobian(panda, place.body, place.pos, q[:1])[0].T, rcond=1e-12)
    assert np.abs(errors @ plain.T).max() > 1e4  # what least squares without damping make of errors alone
    assert np.abs(found.mean[:, :3]).max() < 2 * numbers.force_n
    assert found.told.min() < 0.5
    lines = list(wrench_lines([found], numbers, Path("out")))
    assert any("the joints never tell" in line for line in lines), lines


@pytest.mark.parametrize("near", [False, True], ids=["anywhere", "near singular poses"])
def test_standard_deviations_hold_the_errors_of_wrenches(near, panda, numbers):
    rows = 4000
    q, rng = posed(rows, seed=2)
    if near:
        q[:, [3, 5]] = rng.uniform(-0.02, 0.02, (rows, 2))
    place, std = place_of(panda, "hand"), rng.uniform(0.2, 2.0, (rows, 7))
    true = LARGE * rng.uniform(-1, 1, (rows, 6))
    read = torques(panda, place, q, true) + std * rng.normal(size=std.shape)
    found = wrenches_of(panda, place, q, Estimate(read, std), numbers)
    inside = (np.abs(found.mean - true) < found.std).mean(axis=0)
    if near:  # a wrench that is small beside a large one is nearer than it could be
        assert (inside > 0.64).all()
    else:
        np.testing.assert_allclose(inside, 0.683, atol=0.03)


def test_of_a_planar_arm_only_the_force_in_its_plane_is_told(planar, numbers):
    rng, place = np.random.default_rng(4), place_of(planar, "lower")
    tip = replace(place, pos=(0.4, 0.0, 0.0))
    q = np.column_stack([rng.uniform(-2, 2, ROWS), rng.uniform(0.6, 2.0, ROWS)])
    true = np.column_stack([rng.uniform(-50, 50, (ROWS, 3)), np.zeros((ROWS, 3))])
    found = wrenches_of(planar, tip, q, Estimate(torques(planar, tip, q, true)), numbers)
    assert found.mean.shape == (ROWS, 3)
    assert (np.abs(found.mean[:, [0, 2]] - true[:, [0, 2]]) < 0.5).all()
    assert np.abs(found.mean[:, 1]).max() < 1e-6
    lines = list(wrench_lines([found], numbers, Path("out")))
    assert "  2 joints of the limb move it: a moment there is taken as none" in lines
    assert "  the joints never tell force_y: what is written of it is as good as nothing" in lines


def test_on_a_floating_base_the_joints_of_the_limb_tell(nominal):
    place = place_of(nominal, "L_Wrist2_Link")
    assert place.joints == nominal.robot.layout.limb("LA")
    assert place.moved_by == len(place.joints)


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("tail", "--wrench: 'tail' is not accepted; accepted: base, elbow, forearm, hand, panda_link1"),
        ("base", "--wrench, what joints of the limb move: 'base' is not accepted; accepted: panda_link1"),
    ],
)
def test_a_point_that_is_none_or_that_nothing_moves_is_refused(name, line, panda):
    with pytest.raises(ConfigError, match=line):
        place_of(panda, name)


def test_observe_writes_wrenches_of_points_and_bodies(clean, stored, saying, tmp_path):
    words = ("--robot", "tests/data/arm.yaml", "--wrench", "lower", "--wrench", "upper", "--out", tmp_path / "made")
    log = stored(clean[:2000])
    status, lines = saying(observe, log, *words)
    assert status == 0
    assert lines[-1] == f"written: {tmp_path / 'made' / 'wrench'}.parquet"
    array, note = read_array(tmp_path / "made" / "wrench")
    names = [column["name"] for column in note["columns"]]
    assert names[:6] == [f"{part}_{axis}.lower" for part in ("force", "told_force") for axis in "xyz"]
    assert array.shape == (2000, 12)
    assert (note["method"], note["rate_hz"], note["columns"][0]["unit"]) == ("MOB", 1000.0, "N")
    assert saying(observe, log, "--robot", "tests/data/arm.yaml", "--out", tmp_path / "made")[0] == 0
    assert not list((tmp_path / "made").glob("wrench*"))  # of another run
