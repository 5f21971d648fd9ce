"""What a network learns from logs of one's own: its labels, its recipe at the log's rate, and what its check says."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from demo_push import NETWORK

from mobnet.core.epochs import Epoch
from mobnet.core.errors import ConfigError, DataError
from mobnet.core.estimator import Estimate
from mobnet.core.recording_file import read_sensed, write_recording
from mobnet.core.store import footer_hash
from mobnet.detection.limb import OwnRecording
from mobnet.estimation.label import foot_label
from mobnet.estimation.observe import read_wrenches
from mobnet.estimation.own import RECORDING, OwnLog, limb_of, read_log_folder, read_network_folder
from mobnet.estimation.sampling import Sampling, check_sampling
from mobnet.formats.network import Limb
from mobnet.kernel.low_pass import low_pass
from mobnet.learning.dataset import LimbData
from mobnet.learning.deployed.networks import Prediction
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import point_torque
from mobnet.robotlog.free_check import ValidationSummary, course_of, free_check, held_out, lines_of
from mobnet.robotlog.labels import label_of, limb_data
from mobnet.robotlog.learn import filled, training_of
from mobnet.robotlog.observe import main as observe
from mobnet.robotlog.planted_check import planted_check

GAIN_HZ, RATE_HZ = 100.0, 1000.0
WRENCH = ("fx", "fy", "fz", "mx", "my", "mz")
MAP = """
q: {columns: [q.J1, q.J2]}
v: {columns: [v.J1, v.J2]}
tau_motor: {columns: [tau_motor.J1, tau_motor.J2]}
tool: {columns: [fx, fy, fz, mx, my, mz], body: lower, pos: [0.3, 0.0, 0.05], quat: [0.0, 1.0, 0.0, 0.0]}
"""


@pytest.fixture
def tool_log(clean, stored, tmp_path):
    """The folder of a log whose arm has a sensor at its tip, observed by the command, and what the sensor reads."""
    rows = 3000
    loads = np.random.default_rng(0).normal(size=(rows, 6)) * [5, 5, 5, 1, 1, 1]
    table = clean[:rows].assign(**dict(zip(WRENCH, loads.T, strict=True)))
    (tmp_path / "map.yaml").write_text(MAP)
    words = [str(stored(table)), "--robot", "tests/data/arm.yaml", "--map", str(tmp_path / "map.yaml")]
    assert observe([*words, "--out", str(tmp_path / "tool")]) == 0
    return tmp_path / "tool", loads


def test_the_label_of_a_tool_is_its_wrench_through_the_jacobian_behind_the_low_pass(tool_log, arm):
    folder, loads = tool_log
    log, nominal = read_log_folder(folder, arm.layout), NominalModel(arm)
    turned = np.diag([1.0, -1.0, -1.0])  # half a turn about x
    q = log.recording.sensed.q
    expected = low_pass(point_torque(nominal, "lower", (0.3, 0.0, 0.05), turned, q, loads), GAIN_HZ, RATE_HZ)
    np.testing.assert_allclose(label_of(log, nominal, "tool"), expected, atol=1e-4)
    assert "tau_ext" not in log.recording.meta["absent"]
    data = limb_data([log, log], [expected, expected], arm.layout, Limb(joints=("A",), Q=("A",), T=()))
    np.testing.assert_allclose(data.targets[: len(q)], log.residual - expected, atol=1e-5)
    assert data.segments == ((0, len(q)), (len(q), 2 * len(q)))
    assert data.input_names == ("q.J1", "q.J2", "v.J1", "v.J2")


def test_a_tool_on_a_body_that_is_not_there_is_told(tool_log, arm, tmp_path, caplog):
    (tmp_path / "map.yaml").write_text(MAP.replace("body: lower", "body: hand"))
    words = [str(tmp_path / "log.csv"), "--robot", "tests/data/arm.yaml", "--map", str(tmp_path / "map.yaml")]
    assert observe([*words, "--out", str(tmp_path / "other")]) == 1
    assert "body: 'hand' is not accepted; accepted: lower, upper, wall" in caplog.text


@pytest.fixture
def two_logs(arm_log, tmp_path):
    """The folders of two logs of equal length, each observed by the command."""
    for seed, name in enumerate(("one", "other")):
        arm_log(seed, seconds=2.0).to_csv(tmp_path / f"{name}.csv", index=False)
        words = [str(tmp_path / f"{name}.csv"), "--robot", "tests/data/arm.yaml", "--out", str(tmp_path / name)]
        assert observe(words) == 0
    return tmp_path / "one", tmp_path / "other"


def test_a_folder_with_the_recording_of_another_log_is_refused(two_logs, arm):
    one, other = two_logs
    for name in ("recording.json", "recording.parquet"):
        shutil.copy(one / name, other / name)
    accepted = rf"accepted: {footer_hash(one / 'recording.parquet')}, the footer in .*; observe the log anew$"
    with pytest.raises(DataError, match=rf"estimate.json: recording: '\w+' is not accepted; {accepted}"):
        read_log_folder(other, arm.layout)
    with pytest.raises(DataError, match=rf"estimate.json: recording: '\w+' is not accepted; {accepted}"):
        OwnRecording.read_files(one / "recording", other / "estimate", arm, "A")


def test_an_estimate_of_an_earlier_version_does_not_say_of_which_recording_it_is(two_logs, arm):
    one, _ = two_logs
    note = json.loads((one / "estimate.json").read_text())
    assert note.pop("recording") == read_log_folder(one, arm.layout).footer
    (one / "estimate.json").write_text(json.dumps(note))
    assert read_log_folder(one, arm.layout).sampling.gain_hz == GAIN_HZ


def test_the_label_of_feet_is_that_of_the_workflow(made_up, nominal, layout, tmp_path):
    recording = made_up(seed=1, seconds=0.5, segments=2)
    write_recording(tmp_path / RECORDING, recording, layout)
    read = read_sensed(tmp_path / RECORDING, layout)
    log = OwnLog(tmp_path, read, np.zeros((len(read.sensed), layout.nv)), Sampling(RATE_HZ, GAIN_HZ, "mean"))
    expected = foot_label(nominal, read, read_wrenches(tmp_path / RECORDING, nominal.robot), GAIN_HZ)
    np.testing.assert_array_equal(label_of(log, nominal, "feet"), expected)


@pytest.mark.parametrize(("rate_hz", "strides"), [(1000.0, [10, 3]), (250.0, [2]), (100.0, []), (4000.0, [40, 12])])
def test_a_training_keeps_its_times_at_any_rate(rate_hz, strides, settings, arm_table):
    training = training_of(settings, arm_table, "A", "free", rate_hz, 7)
    assert [phase.stride for phase in training.learning.coarse] == strides
    assert (training.network.cell, training.network.hidden, training.epochs) == ("GRU", 150, 7)


def test_free_motion_hides_torques_from_the_network_and_sensors_do_not(settings, robot_table, arm_table):
    assert robot_table.networks["LL"].T == ("LL",)
    assert training_of(settings, robot_table, "LL", "free", RATE_HZ, 1).network.T == ()
    assert training_of(settings, robot_table, "LL", "feet", RATE_HZ, 1).network.T == ("LL",)
    assert training_of(settings, arm_table, "A", "tool", RATE_HZ, 1).network.T == ("A",)


def test_a_short_log_fills_its_batches(settings, arm_table):
    training = training_of(settings, arm_table, "A", "free", 250.0, 1)
    assert filled(training, [(0, 150_000)], settings).learning.batch_size <= training.learning.batch_size
    assert 1 <= filled(training, [(0, 2_000)], settings).learning.batch_size <= 2_000 // 100


@pytest.mark.parametrize(("batches", "lanes"), [(0.5, 1), (1, 1), (7.9, 7), (1000, 64)])
def test_an_epoch_has_its_updates_however_long_the_log_is(settings, arm_table, batches, lanes):
    training = training_of(settings, arm_table, "A", "free", 250.0, 1)
    samples = round(batches * training.network.horizon_steps * settings.robotlog.learn.updates)
    short = training.model_copy(update={"epoch_samples": samples})
    assert training.learning.batch_size == 64
    assert filled(short, [(0, 10_000_000)], settings).learning.batch_size == lanes


class Half:
    """A network that predicts half of the residual, which is its only input; its sigma holds a share of the errors."""

    def __init__(self, holds=0.68):
        self.holds = holds

    def run_all(self, lanes):
        held = [np.arange(len(lane))[:, None] % 100 < 100 * self.holds for lane in lanes]
        return [
            Prediction(0.5 * x, np.where(own, 1.1, 0.1) * np.abs(0.5 * x)) for x, own in zip(lanes, held, strict=True)
        ]


def made_check(settings, size=1.0, network=None):
    x = np.float32(np.where(np.arange(1000) % 2, 1.0, -1.0))[:, None]
    x[800:] *= size
    data, numbers = LimbData(x, x, ((0, 1000),), ("x",), ("J1",), 100.0), settings.robotlog.learn
    held = held_out(network or Half(), data, 800)
    return free_check(held, data, 0.2 * np.ones((1000, 1)), 800, ["N m"], numbers.margin)


FALLS = ValidationSummary(kept=40, epochs=40, loss=-1.5, last=-1.5)


@pytest.mark.parametrize(("size", "told"), [
    (1.0, ["the log suffices: yes"]),
    (3.0, ["the log suffices: no", "outside the range of training, most often x", "3.0 times that on data"]),
])  # fmt: skip
def test_the_check_measures_what_is_held_out_and_says_whether_the_log_suffices(size, told, settings):
    found = made_check(settings, size)
    assert (found.seconds, found.zero[0]) == (pytest.approx(2.0), pytest.approx(0.2))
    assert (found.observer[0], found.network[0], found.seen[0]) == pytest.approx((size, size / 2, 0.5))
    assert found.outside == (size > 1.0)  # every sample, on both sides
    text = "\n".join(lines_of(found, "free", settings.robotlog.learn, FALLS))
    assert all(line in text for line in told), text


def test_a_log_never_suffices_while_the_validation_rises(settings, tmp_path):
    """As on the logs of a UR10e: epoch 1 of 40 is kept, and the loss rises from 1.2 to 18.5."""
    epochs = [Epoch(k + 1, 1.0, 1.2 + 0.44 * k, 3.0, 0.01, 1.0, 1) for k in range(40)]
    rows = [vars(epoch) for epoch in epochs]
    pd.DataFrame(rows).to_csv(tmp_path / "metrics.csv", index=False)
    course = course_of(tmp_path / "metrics.csv", kept=1)
    text = "\n".join(lines_of(made_check(settings), "free", settings.robotlog.learn, course))
    assert "the log suffices: no" in text
    assert "the validation rises after epoch 1 of 40, which is kept, from 1.20 to 18.36: the network learns" in text


def test_a_log_never_suffices_where_sigma_holds_another_share_of_the_errors(settings):
    found = made_check(settings, network=Half(holds=0.41))
    text = "\n".join(lines_of(found, "free", settings.robotlog.learn, FALLS))
    assert "the log suffices: no" in text
    assert "sigma holds 41% to 41% of the errors in place of 68%, wrong at J1: record more varied motion" in text


@pytest.fixture
def held_arm(arm):
    """Return a function of the sizes of errors that plants pushes into a minute in which the arm sways."""
    rate_hz, rows = 200.0, 12_000
    t, rng = np.arange(rows)[:, None] / rate_hz, np.random.default_rng(0)
    q, noise = 0.5 * np.sin(t * [1.0, 1.7]), rng.normal(size=(rows, 2))

    def check(settings, observers, network, std):
        sampling = Sampling(rate_hz, GAIN_HZ, "sample")
        estimate = Estimate(network * noise, std * np.ones_like(noise))
        errors = [size * noise for size in observers]
        return planted_check(NominalModel(arm), "A", sampling, q, ((0, rows),), estimate, errors, settings)

    return check


@pytest.mark.parametrize(("observers", "network", "kept"), [
    ((20.0, 4.0), 2.0, "network, mean"), ((20.0, 4.0), 8.0, "observer"), ((4.0, 8.0), 6.0, "observer without the"),
])  # fmt: skip
def test_of_nothing_formula_and_network_the_one_is_kept_that_finds_most_planted_pushes(
    observers, network, kept, settings, held_arm
):
    found = held_arm(settings, observers, network, 1.0)
    assert found.kept.startswith(kept)
    assert found.pushes >= settings.robotlog.planted
    assert found.has_network == kept.startswith("network")
    assert found.note()["kept"] == found.kept
    assert found.line().startswith(
        f"of {found.pushes} pushes planted there, found without a false alarm: observer with"
    )
    text = "\n".join(lines_of(made_check(settings), "free", settings.robotlog.learn, FALLS, found))
    assert found.line() in text
    assert ("the log suffices: yes" in text) == found.has_network


def test_a_table_without_friction_has_one_observer_and_a_short_part_no_pushes(settings, held_arm, arm):
    found = held_arm(settings, (4.0,), 2.0, 1.0)
    assert list(found.found) == ["observer", "network, mean", "network, ratio"]
    none = np.zeros((50, 2))
    sampling = Sampling(200.0, GAIN_HZ, "sample")
    short = planted_check(
        NominalModel(arm), "A", sampling, none, ((0, 50),), Estimate(none, none + 1), [none], settings
    )
    assert short is None


def test_the_limb_is_the_only_one_or_has_to_be_named(layout, arm):
    assert limb_of(arm.layout, None) == "A"
    with pytest.raises(ConfigError, match=r"--limb: 'nothing' is not accepted; accepted: .*LL"):
        limb_of(layout, None)


def test_a_network_that_learned_the_external_torque_itself_is_taken_off_no_residual(settings, layout, tmp_path):
    made = NETWORK
    assert read_network_folder(made, layout, settings).limb == "LL"
    shutil.copytree(made, tmp_path / "net")
    note = json.loads((made / "run.json").read_text())
    (tmp_path / "net" / "run.json").write_text(json.dumps(note | {"target": "external"}))
    with pytest.raises(DataError, match=r"run.json: target: 'external' is not accepted; accepted: uncertainty"):
        read_network_folder(tmp_path / "net", layout, settings)


def test_logs_of_rates_that_differ_a_little_name_what_gives_them_one():
    """A logger without a clock of its own writes 94.0, 95.3 and 95.0 rows a second."""
    given = Sampling(94.0, 100.0, "sample")
    with pytest.raises(
        DataError, match=r"two: rate_hz: 95.3 is not accepted; .* one `rate_hz` in the maps of all logs"
    ):
        check_sampling(Path("two"), replace(given, rate_hz=95.3), given, Path("one"))
