"""The eleven names that programs of others import: what they accept, and that they are those of the page."""

import inspect
import re
import shutil
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from made_contacts import pushed

import mobnet
from mobnet.core.files import RUN, WEIGHTS
from mobnet.detection.threshold_file import write_thresholds
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.robot.given import given_robot
from mobnet.settings.lab import CONFIGS, load_lab

ROOT = Path(__file__).parents[3]
ARM, DEMO = ROOT / "tests" / "data" / "arm.yaml", ROOT / "docs" / "demo"
PAGE = (ROOT / "docs" / "interface.md").read_text()
LEG = DEMO / "networks" / "MOB-Net-pushed-LL"
JOINTS = tuple(f"LL{k}" for k in range(1, 7))
HEAVY = ("numpy", "pinocchio", "numba", "torch", "mujoco")
PUSH = slice(1700, 1760)  # rows of the demo's recording in which its push acts


@pytest.fixture(scope="module")
def arm():
    return mobnet.Robot.read(ARM)


@pytest.fixture(scope="module")
def humanoid():
    return mobnet.Robot.read(CONFIGS / "robots" / "tocabi.yaml")


@pytest.fixture(scope="module")
def walk(humanoid):
    return mobnet.read_recording(DEMO / "recording", humanoid)


@pytest.fixture
def thresholds(tmp_path, humanoid):
    """A function of changes to the thresholds of the demo's leg, which returns their file."""

    def make(**changes):
        values = {
            "robot": humanoid.name, "limb": "LL", "joints": JOINTS, "method": "MOB", "signal": "mean",
            "thresholds": (8.0, 70.0, 70.0, 90.0, 40.0, 30.0), "watched": "always", "settle_s": 0.5,
            "low_pass_hz": 15.0, "hold_s": 0.005, "rate_hz": 1000.0, "gain_hz": 100.0, "torque": "mean",
            "rate_per_h": 1.0,
            "expected_per_h": 1.0, "low_per_h": 0.5, "high_per_h": 2.0, "confidence": 0.95,
        }  # fmt: skip
        path = tmp_path / "thresholds.yaml"
        write_thresholds(path, LimbThresholds(**{**values, **changes}))
        return path

    return make


def test_the_names_are_those_of_the_page_and_each_is_told():
    table = PAGE.partition("| name | what it is |")[2].partition("\n\n")[0]
    rows = [line.split("|")[1] for line in table.splitlines() if line.startswith("| `")]
    assert sorted(re.findall(r"`(\w+)`", "".join(rows))) == mobnet.__all__ == dir(mobnet)
    assert all(getattr(mobnet, name).__doc__ for name in mobnet.__all__)
    with pytest.raises(AttributeError, match="no attribute 'Detektor'"):
        mobnet.Detektor  # noqa: B018


def test_signatures_of_the_page_are_those_of_the_code():
    lines = "".join(re.findall(r"^```text\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)).splitlines()
    told = dict(re.match(r"([\w.]+)\((.*?)\)(?: ->|$)", line).groups() for line in lines)
    assert {name.partition(".")[0] for name in told} == set(mobnet.__all__) - {"MobnetError"}
    for name, arguments in told.items():
        place, _, method = name.partition(".")
        function = getattr(mobnet, place)
        parameters = inspect.signature(getattr(function, method) if method else function).parameters.values()
        plain = [one.replace(annotation=inspect.Parameter.empty) for one in parameters if one.name != "self"]
        written = [str(one).replace("'", '"').replace(" = ", "=") for one in plain]
        assert arguments == ", ".join(written), name


def test_every_class_and_function_has_an_example():
    code = "".join(re.findall(r"^```python\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE))
    assert [name for name in mobnet.__all__ if f"mobnet.{name}" not in code] == []
    for name in ("Detector", "Robot", "Observer", "Estimator", "ContactFinder", "ReactionHandler"):
        public = {method for method in vars(getattr(mobnet, name)) if not method.startswith("_")}
        assert [method for method in public if f"{name}.{method}(" not in PAGE and f"`{method}`" not in PAGE] == []


def test_the_examples_of_a_humanoid_run(humanoid, walk, thresholds, capsys):
    blocks = re.findall(r"^```python\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    locate, react = [block for block in blocks if "humanoid" in block]
    q = np.zeros(humanoid.description.layout.nq)
    q[3] = 1.0
    knee = next(point for point in humanoid.description.points if point.name == "left_knee_side")
    torques = pushed(humanoid.description, q, knee.body, knee.pos, [0.0, -50.0, 0.0])
    joints = humanoid.limbs["LL"] + humanoid.limbs["RL"] + humanoid.limbs["V"]
    columns = humanoid.description.layout.columns(joints)
    found = thresholds(thresholds=(4.0, 12.0, 20.0, 12.0, 6.0, 5.0))
    names = {
        "mobnet": mobnet, "humanoid": humanoid, "q": q, "tau": torques[columns], "std": np.full(len(columns), 0.1),
        "leg_estimator": mobnet.Estimator.from_folder(humanoid, LEG),
        "leg_detector": mobnet.Detector.from_files(humanoid, None, found),
        "walk": [walk.sensed[k] for k in range(len(walk.sensed))],
    }  # fmt: skip
    exec(locate, names)
    assert capsys.readouterr().out.startswith(f"{knee.body}: ")
    exec(react, names)
    assert capsys.readouterr().out.startswith("LL was hit: ")


def test_each_name_tells_a_notebook_what_it_is(arm, humanoid, walk, thresholds):
    assert repr(arm) == "Robot two-link arm: J1, J2; fixed base"
    assert repr(humanoid) == "Robot TOCABI: V (6), LL (6), RL (6), W (3), LA (8), RA (8), N (2); floating base"
    assert repr(mobnet.Observer(arm, 500.0)) == "Observer: J1, J2, 500 Hz, gain 100 1/s"
    estimator = mobnet.Estimator.from_folder(humanoid, LEG)
    assert repr(estimator) == "Estimator: LL1, LL2, LL3, LL4, LL5, LL6, 1000 Hz"
    detector = mobnet.Detector.from_files(humanoid, None, thresholds())
    shown = "Detector of limb LL: LL1, LL2, LL3, LL4, LL5, LL6, 1000 Hz, false alarms promised: 1 1/h"
    assert repr(detector) == shown
    finder = mobnet.ContactFinder(humanoid, "LL", joints=(*humanoid.limbs["LL"], *humanoid.limbs["V"]))
    assert repr(finder) == "ContactFinder: 12 joints"
    handler = mobnet.ReactionHandler(humanoid, estimator, [detector], foot_spacing_m=0.205)
    assert repr(handler) == "ReactionHandler: watches LL"
    assert repr(walk) == f"Recording of TOCABI: {len(walk.sensed) / 1000:.1f} s at 1000 Hz, 1 segment"


def test_a_recording_is_a_table_and_a_picture(walk, humanoid):
    table = walk.frame()
    assert len(table) == len(walk.sensed)
    np.testing.assert_array_equal(table["tau_motor.LL3"], walk.sensed.tau_motor[:, 2])
    np.testing.assert_array_equal(table["q.LL3"], walk.sensed.q[:, 7 + 2])
    assert table.index[1000] == 1.0
    assert table.columns.is_unique
    figure = walk.plot()
    assert [panel.get_ylabel() for panel in figure.axes] == [
        "position [rad]",
        "velocity [rad/s]",
        "torque of the motor [N m]",
    ]
    plt.close(figure)


def test_the_import_alone_loads_no_package():
    code = f"import mobnet, sys; print([name for name in {HEAVY} if name in sys.modules])"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT / "src")
    assert said.stdout == "[]\n"


def test_the_names_need_no_configuration_and_few_lines():
    """What a stranger reads who takes the interface. Lower the number, never raise it."""
    code = """
import sys
import mobnet
for name in mobnet.__all__:
    getattr(mobnet, name)
for name, module in sys.modules.items():
    if name.partition(".")[0] in ("mobnet", "pyarrow", "safetensors"):
        print(name, module.__file__)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    files = dict(line.split() for line in done.stdout.splitlines())
    assert {name.partition(".")[0] for name in files} == {"mobnet"}
    assert not {name for name in files if name.startswith(("mobnet.settings", "mobnet.formats.reading"))}
    assert sum(len(Path(file).read_text().splitlines()) for file in files.values()) <= 8000


def test_a_robot_of_a_urdf_is_that_of_the_table_that_the_command_makes():
    arm = mobnet.Robot.read(ROOT / "tests" / "data" / "arm.urdf")
    assert len(arm.motors) == len(arm.joints) == 2
    assert set(arm.limbs[next(iter(arm.limbs))]) == set(arm.joints)


def test_a_sample_holds_what_is_given_and_zero_elsewhere(humanoid, walk):
    sensed = walk.sensed[100]
    sample = humanoid.sample(sensed.q, sensed.v, sensed.tau_motor, acc=sensed.acc_base_in_base, swing=[1.0, 0.0])
    np.testing.assert_array_equal(sample.q, sensed.q)
    np.testing.assert_array_equal(sample.acc_base_in_base, sensed.acc_base_in_base)
    np.testing.assert_array_equal(sample.tau_des, sensed.tau_motor)
    assert sample.swing.tolist() == [1.0, 0.0]
    assert not sample.landing.any()


@pytest.mark.parametrize(("change", "says"), [
    ({"q": [0.0]}, r"q: shape: \(1,\) is not accepted; accepted: \(2,\)"),
    ({"v": [[0.0, 0.0]]}, r"v: shape: \(1, 2\) is not accepted; accepted: \(2,\)"),
    ({"tau_motor": [0.0, float("nan")]}, "tau_motor: nan is not accepted; accepted: finite numbers"),
    ({"acc": [0.0, 0.0, 9.8]}, r"acc: shape: \(3,\) is not accepted; accepted: \(0,\)"),
])  # fmt: skip
def test_what_is_no_sample_of_the_robot_is_one_line(arm, change, says):
    given = {"q": [0.0, 0.0], "v": [0.0, 0.0], "tau_motor": [0.0, 0.0]}
    with pytest.raises(mobnet.MobnetError, match=says) as refused:
        arm.sample(**{**given, **change})
    assert "\n" not in str(refused.value)


def test_an_observer_step_by_step_is_that_of_the_whole(humanoid, walk):
    observer = mobnet.Observer(humanoid, walk.rate_hz, torque="mean")
    whole = observer.residual(walk.sensed[:50])
    state, rows = observer.init(), []
    for k in range(50):
        state, residual = observer.step(state, walk.sensed[k])
        rows.append(residual)
    np.testing.assert_allclose(rows, whole, atol=1e-9)
    assert whole.shape == (50, len(humanoid.joints))


def test_a_folder_of_folders_is_an_estimator_of_all_their_limbs(humanoid, walk, tmp_path):
    shutil.copytree(LEG, tmp_path / "networks" / "left")
    together = mobnet.Estimator.from_folder(humanoid, tmp_path / "networks")
    alone = mobnet.Estimator.from_folder(humanoid, LEG)
    assert together.joints == alone.joints == JOINTS
    one, other = (estimator.estimate(walk.sensed[:200]) for estimator in (together, alone))
    np.testing.assert_array_equal(one.tau_ext, other.tau_ext)
    np.testing.assert_array_equal(one.std, other.std)


def test_two_networks_of_a_limb_are_refused(humanoid, tmp_path):
    for name in ("one", "two"):
        shutil.copytree(LEG, tmp_path / name)
    with pytest.raises(mobnet.MobnetError, match=f"{tmp_path}/two: {tmp_path}/one is of limb LL, too"):
        mobnet.Estimator.from_folder(humanoid, tmp_path)


def test_a_folder_without_networks_is_named(humanoid, tmp_path):
    with pytest.raises(mobnet.MobnetError, match=f"{tmp_path}: {RUN} is missing"):
        mobnet.Estimator.from_folder(humanoid, tmp_path)


def test_a_detector_finds_the_push_of_the_demo_and_begins_anew_after_a_reset(humanoid, walk, thresholds):
    detector = mobnet.Detector.from_files(humanoid, None, thresholds())
    alarms = [detector.step(walk.sensed[k]) for k in range(len(walk.sensed))]
    on = [k for k, alarm in enumerate(alarms) if alarm.is_on]
    assert on
    assert on[0] >= 500  # it settles until then
    assert set(on) & set(range(PUSH.start, PUSH.stop + 100))
    assert {alarms[k].joint for k in on} <= set(JOINTS)
    assert alarms[on[0]].estimate.tau_ext.shape == (6,)
    detector.reset()
    assert [detector.step(walk.sensed[k]).ratio for k in range(600)] == [alarm.ratio for alarm in alarms[:600]]


def test_thresholds_of_another_robot_are_refused(humanoid, thresholds):
    with pytest.raises(mobnet.MobnetError, match="made for robot 'other', and '"):
        mobnet.Detector.from_files(humanoid, None, thresholds(robot="other"))


def test_a_finder_names_the_body_that_is_pushed(humanoid):
    q = np.zeros(humanoid.description.layout.nq)
    q[3] = 1.0
    joints = humanoid.description.layout.limbs(["LL", "RL", "V"])
    knee = next(point for point in humanoid.description.points if point.name == "left_knee_side")
    torques = pushed(humanoid.description, q, knee.body, knee.pos, [0.0, -50.0, 0.0])
    tau = torques[humanoid.description.layout.columns(joints)]
    found = mobnet.ContactFinder(humanoid, "LL", joints).locate(q, tau, np.full(len(joints), 0.1))
    assert found.body == knee.body


def test_a_handler_answers_a_push_with_steps(humanoid, walk, thresholds):
    """Detectors and handler have the demo's leg alone, so that the joints of arms and base count as untouched."""
    estimator = mobnet.Estimator.from_folder(humanoid, LEG)
    detector = mobnet.Detector.from_files(humanoid, None, thresholds(thresholds=(4.0, 12.0, 20.0, 12.0, 6.0, 5.0)))
    handler = mobnet.ReactionHandler(humanoid, estimator, [detector], foot_spacing_m=0.205)
    answers = [(k, handler.step(walk.sensed[k])) for k in range(len(walk.sensed))]
    (found,) = [(k, answer) for k, answer in answers if answer]
    row, reacted = found
    assert row >= 500
    assert reacted.limb == "LL"
    assert reacted.steps.shape[1] == 5


def test_an_export_is_that_of_the_command(humanoid, tmp_path):
    contract = mobnet.export_networks([LEG], humanoid, tmp_path)
    assert contract == tmp_path / "contract.json"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["LL.onnx", "contract.json", "model.bin"]
    assert (LEG / WEIGHTS).is_file()


def test_a_command_takes_a_urdf_where_it_takes_a_table(tmp_path):
    robot = ROOT / "tests" / "data" / "arm.urdf"
    given = given_robot(robot, load_lab().robot)
    assert given.layout.actuated == mobnet.Robot.read(robot).motors
    (tmp_path / "arm.urdf").write_text("<robot/>")
    with pytest.raises(mobnet.MobnetError, match=r"arm\.urdf"):
        given_robot(tmp_path / "arm.urdf", load_lab().robot)
