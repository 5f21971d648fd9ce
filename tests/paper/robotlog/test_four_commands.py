"""From CSV files of an arm to flags in four commands, as docs/detection.md tells it, and to the same on a robot."""

import csv
import json
import logging
import re
import shutil
import sys
from pathlib import Path

import c_library
import numpy as np
import pandas as pd
import pytest
import yaml
from made_arm import arm_log

from experiments.commands.main import MODULES
from experiments.commands.words import parse
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import read_array
from mobnet.detection.calibrate import main as calibrate
from mobnet.detection.threshold_file import read_thresholds
from mobnet.export.export import main as export
from mobnet.formats.loading import load_section
from mobnet.formats.log_map import LogMap
from mobnet.robotlog.detect import main as detect
from mobnet.robotlog.flags import stretches
from mobnet.robotlog.learn import main as learn
from mobnet.robotlog.observe import converted_log
from mobnet.robotlog.observe import main as observe

pytestmark = pytest.mark.slow
FOUR = {"observe": observe, "learn": learn, "calibrate": calibrate, "detect": detect}
COMMANDS = {**FOUR, "export": export}
ARM = Path("tests/data/arm.yaml").resolve()
RATE_HZ, SHORT = 200.0, ("--epochs", "4")
GUIDE, LOG_PAGE, RUNTIME, INTERFACE = (
    Path(f"docs/{name}.md").resolve() for name in ("detection", "logs", "runtime", "interface")
)
EXAMPLE = Path("docs/examples/run_onnx.py").resolve()
PUSHES = (10.0, 0.3, (0.0, 6.0)), (20.0, 0.3, (9.0, 0.0))  # start, duration [s], torque of each joint [N m]
LOGS = {"train": (1, 100.0, ()), "free": (2, 220.0, ()), "new": (3, 30.0, PUSHES)}  # seed, duration [s], pushes
OWN, LATE_S = ("--robot", ARM), 0.1


def run(*words):
    """Run a command as `./reproduce` does; return its status."""
    taken = parse([str(word) for word in words])
    assert taken.command in MODULES
    return COMMANDS[taken.command](taken.extra)


def lines_of(text, *commands):
    """Return the words after `./reproduce` of each line of a text that runs one of some commands."""
    return [line for line in re.findall(r"^ {4}\./reproduce (.*)$", text, re.MULTILINE) if line.split()[0] in commands]


@pytest.fixture(scope="module")
def made(arm, tmp_path_factory):
    """The folder in which the commands of the page have run, the training shortened."""
    folder, page = tmp_path_factory.mktemp("arm"), GUIDE.read_text().partition("## Calibrate")[0]
    signals = {name: {"columns": [f"{name}.J1", f"{name}.J2"]} for name in ("q", "v", "tau_motor")}
    lines = lines_of(page, *MODULES)
    assert list(dict.fromkeys(line.split()[0] for line in lines)) == list(FOUR)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        Path("arm.yaml").symlink_to(ARM)
        Path("arm.urdf").symlink_to(ARM.with_suffix(".urdf"))
        Path("map.yaml").write_text(yaml.safe_dump(signals))
        for name, (seed, seconds, pushes) in LOGS.items():
            arm_log(arm, seconds, RATE_HZ, seed, pushes).to_csv(f"{name}.csv", index=False)
        for line in lines:
            assert run(*line.split(), *(SHORT if line.startswith("learn") else ())) == 0
    return folder


def test_the_interval_of_false_alarms_says_that_it_is_nominal(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    caplog.set_level(logging.INFO)
    assert run("calibrate", "free", *OWN, "--network", "arm_net", "--rate", "1") == 0
    said = r"1 in an hour of free motion, nominal 95% interval \S+ to \S+, which takes windows for independent$"
    assert any(re.search(said, line) for line in caplog.messages)


def test_the_network_s_error_is_below_the_observer_s(made):
    found = json.loads((made / "arm_net" / "run.json").read_text())
    check = found["check"]
    assert (found["rate_hz"], found["gain_hz"], found["torque"], found["labels"]) == (RATE_HZ, 100.0, "sample", "free")
    assert check["seconds"] == pytest.approx(15.0)
    assert (np.array(check["network"]) < 0.3 * np.array(check["observer"])).all()
    assert np.allclose(check["covered"][0], 0.68, atol=0.15)


def test_thresholds_are_those_of_the_network_and_below_the_observer_s(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    caplog.set_level(logging.INFO)
    found = read_thresholds(made / "arm_thresholds.yaml")
    assert (found.robot, found.limb, found.joints, found.watched) == ("two-link arm", "A", ("J1", "J2"), "always")
    assert found.network == json.loads((made / "arm_net" / "run.json").read_text())["fingerprint"]
    assert found.expected_per_h == pytest.approx(1.0)
    assert found.low_per_h <= 1.0 <= found.high_per_h
    assert found.signal == "ratio"
    words = ("--network", "arm_net", "--signal", "mean", "--out", "mean.yaml")
    assert run("calibrate", "free", *OWN, *words) == 0
    said = "\n".join(caplog.messages)
    (share,) = re.findall(
        r"^smallest torques with the network over .* alone: (\d+)%, geometric mean$", said, re.MULTILINE
    )
    assert int(share) < 50
    residual = np.abs(read_array(Path("free/estimate"))[0]).max(axis=0)
    assert (np.array(read_thresholds(Path("mean.yaml")).thresholds) < residual).all()


def test_flags_stand_at_the_pushes_and_nowhere_else(made):
    rows = list(csv.DictReader((made / "new" / "flags.csv").read_text().splitlines()))
    assert len(rows) == len(PUSHES)
    for row, (start, duration, torque) in zip(rows, PUSHES, strict=True):
        assert start <= float(row["start_s"]) <= start + LATE_S
        assert float(row["end_s"]) <= start + duration + LATE_S
        assert row["joint"] == f"J{1 + int(np.argmax(torque))}"
        assert float(row["ratio"]) > 2.0
        assert row["link"] == ""  # the table has no points
    estimate, note = read_array(made / "new" / "estimate")
    assert [column["name"] for column in note["columns"]] == ["tau_ext.J1", "tau_ext.J2", "std.J1", "std.J2"]
    push = slice(round(10.0 * RATE_HZ), round(10.3 * RATE_HZ))
    assert estimate[push, 1].max() == pytest.approx(6.0, rel=0.2)
    assert (made / "new" / "flags.png").stat().st_size > 10_000


def test_the_wrench_has_standard_deviations_where_the_network_has_them(made, monkeypatch):
    monkeypatch.chdir(made)
    words = (
        "--robot arm.yaml --map map.yaml --network arm_net --thresholds arm_thresholds.yaml --wrench lower --out pulled"
    )
    assert run("detect", "new.csv", *words.split()) == 0
    array, note = read_array(Path("pulled/wrench"))
    names = [column["name"] for column in note["columns"]]
    signals = ("force", "std_force", "told_force")
    assert names == [f"{signal}_{axis}.lower" for signal in signals for axis in "xyz"]
    assert (array[:, 3:6] > 0.0).all()
    assert note["method"] == "MOB-Net"


def test_the_page_of_logs_has_the_same_log_and_the_same_network(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    caplog.set_level(logging.INFO)
    first, with_wrench, second = lines_of(LOG_PAGE.read_text(), "observe", "learn")
    assert run(*with_wrench.replace("--wrench hand", "--wrench lower").split()) == 0  # this arm has no hand
    assert Path("new/wrench.parquet").exists()
    assert first == lines_of(GUIDE.read_text(), "observe")[0]
    assert run(*second.split(), *SHORT) == 0
    assert "arm_net: already trained from these logs in this way" in caplog.text


def test_an_estimate_of_a_file_has_the_thresholds_of_its_folder(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    caplog.set_level(logging.INFO)
    (line,) = [line for line in lines_of(GUIDE.read_text(), "calibrate") if "--estimate" in line]
    told = []
    for words in (line.split(), ("calibrate", "free", *OWN, "--rate", "1")):
        caplog.clear()
        assert run(*words) == 0
        told.append([one.message for one in caplog.records if one.name == calibrate.__module__])
    assert told[0] == told[1] != []


def test_a_loop_over_the_samples_has_the_flags_of_the_command(made, arm, settings, monkeypatch):
    monkeypatch.chdir(made)
    _, code, _ = re.findall(r"^```python\n(.*?)^```$", GUIDE.read_text(), re.DOTALL | re.MULTILINE)
    meaning = load_section(Path("map.yaml"), LogMap)
    sensed = converted_log(Path("new.csv"), arm.layout, meaning, settings.robotlog).recording.sensed
    names = {"samples": [sensed[k] for k in range(len(sensed))]}
    exec(code, names)
    rows = csv.DictReader(Path("new/flags.csv").read_text().splitlines())
    spans = [[round(float(row[key]) * RATE_HZ) for key in ("start_s", "end_s")] for row in rows]
    assert set(names["flagged"]) <= {k for start, end in spans for k in range(start, end + 1)}
    assert {k for span in spans for k in span} <= set(names["flagged"])


def test_the_examples_of_the_interface_run_on_the_files_of_the_page(made, arm, settings, monkeypatch, capsys):
    monkeypatch.chdir(made)
    blocks = re.findall(r"^```python\n(.*?)^```$", INTERFACE.read_text(), re.DOTALL | re.MULTILINE)
    detect_in_loop, from_model, *others = blocks
    meaning = load_section(Path("map.yaml"), LogMap)
    sensed = converted_log(Path("new.csv"), arm.layout, meaning, settings.robotlog).recording.sensed
    names = {"ticks": list(zip(sensed.q, sensed.v, sensed.tau_motor, strict=True))}
    exec(detect_in_loop, names)
    said = [line.partition(":")[0] for line in capsys.readouterr().out.splitlines()]
    assert list(dict.fromkeys(said)) == ["J2", "J1"]  # pushed in this order, as PUSHES has them
    free = read_sensed(Path("free/recording"), arm.layout).sensed
    names |= {"q_free": free.q, "v_free": free.v, "tau_free": free.tau_motor}
    exec(from_model, names)  # without a network its thresholds are wider
    assert list(dict.fromkeys(capsys.readouterr().out.splitlines())) == ["J2 is pushed", "J1 is pushed"]
    of_an_arm = [code for code in others if "humanoid" not in code]  # tests/library/package runs those of a humanoid
    for code in of_an_arm:
        exec(code, names)
    assert names["torque"].shape == (2,)
    assert capsys.readouterr().out.startswith("q: shape: (1,) is not accepted;")
    of_observer, _ = read_array(Path("free/estimate"))
    np.testing.assert_allclose(names["residual"], of_observer, atol=1e-4)
    np.testing.assert_allclose(names["now"].tau_ext, names["estimate"].tau_ext[99], atol=1e-5)
    again = names["mobnet"].read_recording("mine", names["arm"])
    np.testing.assert_allclose(again.sensed.q, names["samples"].q, atol=1e-6)
    assert names["contract"].is_file()


@pytest.fixture(scope="module")
def exported(made):
    """The folder in which the commands of the page on run time have run too; the log is a CSV file beside its array."""
    page = RUNTIME.read_text()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(made)
        for line in [lines_of(page, "export")[0], *lines_of(page, "observe")]:
            assert run(*line.split()) == 0
        pd.read_parquet("observed/recording.parquet").astype(float).to_csv("observed.csv")
    return made


@pytest.fixture
def spans(made, settings):
    """Return a function of the rows above a threshold that tells the stretches, and those of the command's flags."""

    def of(rows):
        above, gap = np.zeros(round(LOGS["new"][1] * RATE_HZ), dtype=bool), settings.robotlog.flag_gap_s
        above[rows] = True
        flags = pd.read_csv(made / "new" / "flags.csv")
        told = [(round(one.start_s * RATE_HZ), round(one.end_s * RATE_HZ) + 1) for one in flags.itertuples()]
        return stretches(above, ((0, len(above)),), round(gap * RATE_HZ)), told

    return of


@pytest.mark.skipif(not c_library.HAS_COMPILER, reason=c_library.REASON)
def test_the_c_library_flags_the_samples_of_the_command(exported, spans, tmp_path):
    example = c_library.make("example", tmp_path)
    _, *lines = c_library.program(example, exported / "arm_runtime" / "model.bin", exported / "observed.csv")
    found, told = spans([int(line.split(",")[0]) for line in lines])
    assert found == told
    assert {line.split(",")[2] for line in lines} == {"A"}


def test_the_example_for_onnx_flags_the_samples_of_the_command(exported, spans, monkeypatch):
    monkeypatch.chdir(exported)
    line = r"^ {4}\.venv/bin/python docs/examples/run_onnx\.py (.*)$"
    (words,) = re.findall(line, RUNTIME.read_text(), re.MULTILINE)
    printed = " ".join(c_library.program(sys.executable, "-I", EXAMPLE, *words.split()))
    edges = re.findall(r"(\S+) s: A, first J[12] (\S+) s: A, over", printed)
    rows = [k for pair in edges for k in range(*(round(float(time) * RATE_HZ) for time in pair))]
    found, told = spans(rows)
    assert found == told
    assert printed.count(" s: ") == 2 * len(edges)


def test_the_same_words_train_nothing_anew_and_others_are_refused(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    caplog.set_level(logging.INFO)
    weights = Path("arm_net/weights.safetensors")
    before = weights.stat().st_mtime_ns
    assert run("learn", "train", *OWN, *SHORT, "--out", "arm_net") == 0
    assert "arm_net: already trained from these logs in this way" in caplog.text
    assert weights.stat().st_mtime_ns == before
    assert run("learn", "train", *OWN, "--epochs", "5", "--out", "arm_net") == 1
    assert "arm_net holds another network" in caplog.messages[-1]
    assert "--force" in caplog.messages[-1]


@pytest.mark.parametrize(("words", "message"), [
    (("learn", "train", "--labels", "some"), "--labels: 'some' is not accepted; accepted: feet, free, tool"),
    (("learn", "train", "--labels", "feet"), "--labels: 'feet' is not accepted; accepted: free; or a log with swing"),
    (("learn", "train", "--labels", "tool"), "--labels: 'tool' is not accepted; accepted: free; or a log with a `to"),
    (("learn", "train", "--limb", "B"), "--limb: 'B' is not accepted; accepted: A"),
    (("learn", "train", "--epochs", "0"), "--epochs: 0 is not accepted; accepted: a whole number from 1"),
    (("learn", "nowhere"), "nowhere: recording.json is missing; accepted: a folder that `./reproduce observe` wrote"),
    (("calibrate", "train"), "99 s of free motion, in windows of 1 s; 200 s or more are needed"),
    (("learn", "train", "../{here}/train"), "/train is the same log as train; give each log once"),
    (("calibrate", "free", "../{here}/free"), "/free is the same log as free; give each log once"),
    (("calibrate", "free", "train", "--network", "arm_net"), "train: the network learned from it, where its error is"),
    (("calibrate", "free", "--network", "x"), "x: run.json is missing; accepted: a folder that `./reproduce learn` w"),
    (("detect", "train", "--network", "arm_net", "--thresholds", "arm_thresholds.yaml"), "a folder without metadata"),
    (("calibrate", "free", "--signal", "ratio"), "--signal ratio: it needs --network"),
    (("calibrate", "free", "--signal", "x"), "--signal: 'x' is not accepted; accepted: mean, ratio, std"),
    (("calibrate",), "nothing to calibrate from is given; either folders that"),
    (("calibrate", "free", "--rate", "0"), "--rate: 0.0 is not accepted"),
    (("detect", "new.csv", "--thresholds", "arm_thresholds.yaml"), "made for network '.*', and 'none' is given here"),
    (("detect", "new.csv", "--thresholds", "none.yaml"), "none.yaml: file is missing"),
], ids=lambda value: value if isinstance(value, str) else " ".join(value))  # fmt: skip
def test_what_is_wrong_is_one_line(words, message, made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    assert run(*(word.format(here=made.name) for word in words), *OWN) == 1
    (line,) = [record.message for record in caplog.records if record.levelno >= logging.ERROR]
    assert "\n" not in line
    assert re.search(message, line), line


def test_a_log_that_the_network_learned_from_is_known_wherever_it_stands(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    shutil.copytree("train", "moved")
    assert run("calibrate", "free", "moved", *OWN, "--network", "arm_net") == 1
    assert caplog.messages[-1].startswith("moved: the network learned from it, where its error is smaller; accepted:")
    assert run("learn", "train", "moved", *OWN, *SHORT, "--out", "twice_net") == 1
    assert caplog.messages[-1].startswith("moved is the same log as train; give each log once")
    assert not Path("twice_net").exists()


def test_a_network_of_an_earlier_version_knows_its_logs_by_their_folders(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    shutil.copytree("arm_net", "old_net")
    note = json.loads(Path("old_net/run.json").read_text())
    del note["recordings"]
    Path("old_net/run.json").write_text(json.dumps(note))
    assert run("calibrate", "free", "train", *OWN, "--network", "old_net") == 1
    assert caplog.messages[-1].startswith("train: the network learned from it")


def test_a_log_at_another_rate_is_resampled_by_a_map_and_refused_without_one(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    lines = Path("new.csv").read_text().splitlines()
    Path("half.csv").write_text("\n".join(lines[:1] + lines[1::2]) + "\n")
    words = ("detect", "half.csv", *OWN, "--network", "arm_net", "--thresholds", "arm_thresholds.yaml")
    assert run(*words) == 1
    assert "half.csv: its rate is 100.0 Hz, and the thresholds were made at 200 Hz" in caplog.text
    assert run(*words, "--map", "map.yaml") == 0
    assert read_array(Path("half_detected/estimate"))[1]["rate_hz"] == RATE_HZ


def test_a_map_whose_torques_are_others_than_those_of_the_thresholds_is_refused(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    Path("mean.yaml").write_text(Path("map.yaml").read_text() + "torque: mean\n")
    words = ("--network", "arm_net", "--thresholds", "arm_thresholds.yaml", "--map", "mean.yaml")
    assert run("detect", "new.csv", *OWN, *words) == 1
    assert "mean.yaml: torque is 'mean', but arm_thresholds.yaml was made with 'sample'" in caplog.text


def test_pushes_are_planted_and_the_detector_that_finds_most_is_kept_and_named(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    caplog.set_level(logging.INFO)
    assert run("calibrate", "free", *OWN, "--network", "arm_net", "--out", "kept.yaml") == 0
    said = "\n".join(caplog.messages)
    counts = dict(re.findall(r"^  (observer|network, mean|network, ratio) +(\d+) +\d+%$", said, re.MULTILINE))
    assert list(counts) == ["observer", "network, mean", "network, ratio"]
    (kept,) = re.findall("^kept, as it finds most: (.*)$", said, re.MULTILINE)
    assert int(counts[kept]) == max(map(int, counts.values()))
    assert f"network, {read_thresholds(Path('kept.yaml')).signal}" == kept
    planted = json.loads(Path("arm_net/run.json").read_text())["planted"]
    assert list(planted["found"]) == list(counts)
    assert planted["kept"].startswith("network")


def test_thresholds_of_the_observer_alone_leave_the_network_out(made, monkeypatch, caplog):
    """The same words go on where `calibrate` kept the observer."""
    monkeypatch.chdir(made)
    caplog.set_level(logging.INFO)
    assert run("calibrate", "free", *OWN, "--out", "alone.yaml") == 0
    words = "new.csv", *OWN, "--thresholds", "alone.yaml", "--out", "alone"
    assert run("detect", *words, "--network", "arm_net") == 0
    assert "alone.yaml are thresholds of the observer alone: the network is not used" in caplog.text
    assert read_array(Path("alone/estimate"))[1]["network"] is None


def test_a_log_of_another_robot_is_one_line(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    assert run("learn", "train", "--robot", ARM.parents[2] / "configs" / "robots" / "panda.yaml") == 1
    (line,) = caplog.messages
    assert re.fullmatch("train: joint: 'J1' is not accepted; accepted: panda_joint1, .*, those of --robot", line)


def test_thresholds_of_another_robot_are_refused(made, monkeypatch, caplog):
    monkeypatch.chdir(made)
    Path("other.yaml").write_text(ARM.read_text().replace("two-link arm", "another arm"))
    words = (
        "detect",
        "new.csv",
        "--robot",
        "other.yaml",
        "--network",
        "arm_net",
        "--thresholds",
        "arm_thresholds.yaml",
    )
    assert run(*words) == 1
    assert "arm_thresholds.yaml: made for robot 'two-link arm', and 'another arm' is given here" in caplog.text
