"""Run notes, metrics, scores, fits and accounts that break the contract are refused where they are read."""

import json
import re
from copy import deepcopy

import pytest
from made_detections import write_detections
from tests.paper.outside.conftest import AGAINST, refusal_of, refusals, set_at

from experiments.check import check
from experiments.evaluation.measure.learning.trainings import read_training
from experiments.evaluation.number.rows import read_scores
from experiments.evaluation.report.runs_page import read_training_run
from experiments.records.collisions import FILES as DETECTION_FILES
from experiments.running.accounts import read_account
from mobnet.core.errors import DataError
from mobnet.estimation.kinds.dahl import read_dahl
from mobnet.estimation.kinds.friction import read_friction

RUNS = {
    **refusals(
        {
            "seed": ("1", -1),
            "method": (1,),
            "name": ("../x", "/x", "a/b"),
            "limb": ("../LL",),
            "parameters": (0, 1.5),
            "samples": (True,),
            "diverged": ("no", 0),
            "target": ("residual",),
            "settings.network.cell": ("X",),
            "device": ("abacus",),
            "best.validation_loss": ("-3",),
            "on_windows": ([1.0, 2.0],),
            "on_windows.loss": (float("nan"),),
            "on_windows.rmse": (-1.0,),
            "calibration.scale": ([1.0],),
            "calibration.scale.0": (0.0,),
            "calibration.shares": ([],),
            "calibration.after.coverage.0.1": (1.5,),
            "calibration.before.nll": ("1",),
        },
        "name method limb seed target settings parameters samples diverged best on_windows calibration "
        "device precision fingerprint provenance",
    ),
    "epochs of another": (set_at("settings.epochs", 5), "epochs: 3 in metrics.csv and 5 in run.json are not"),
    "epochs too few": (set_at("settings.epochs", 2), "epochs: 3 in metrics.csv and 2 in run.json are not"),
    "best of another": (set_at("best.epoch", 1), "the smallest validation_loss: 3 in metrics.csv and 1 in run.json"),
    "best null": (set_at("best", None), "the smallest validation_loss: 3 in metrics.csv and None in run.json"),
    "joint twice": (set_at("calibration.joints", ["LL1", "LL1"]), "calibration.joints: 'LL1' occurs 2 times"),
    "coverage too long": (set_at("calibration.after.coverage", [[0.5] * 2] * 2), "after.coverage: .*: 1 rows"),
}


@pytest.mark.parametrize("name", RUNS)
def test_a_run_note_that_breaks_the_contract_is_refused(name, training):
    change, says = RUNS[name]
    note = json.loads((training / "run.json").read_text())
    change(note)
    (training / "run.json").write_text(json.dumps(note))
    for read in (lambda: read_training(training), lambda: read_training_run(training)):
        with pytest.raises(DataError, match=says):
            read()
    assert re.search(says, refusal_of(training / "run.json"))


def test_a_sound_training_is_accepted(training):
    for name in ("run.json", "metrics.csv"):
        assert check(training / name, AGAINST) == "training GRU-LL-s1, 3 epochs"


METRICS = {
    "a column is gone": (("gradient_norm", "norm"), "metrics.csv: column 'gradient_norm' is missing; accepted: it, "),
    "a column twice": (("gradient_norm", "epoch"), "metrics.csv: column 'epoch' occurs 2 times"),
    **{
        f"{text!r}": (("-2.0,3.0", f"{text},3.0"), f"metrics.csv:3: validation_loss: '{text}' is not accepted; ")
        for text in ("nan", "inf", "1e999", "low", "", "1_0")
    },
    "a decimal comma": (("-2.0,3.0", "-2,0,3.0"), "metrics.csv:3: .*8 fields; accepted: 7"),
    "epoch as a fraction": (("\n2,", "\n2.0,"), "metrics.csv:3: epoch: '2.0' is not .*: a whole number"),
    "epoch left out": (("\n2,", "\n3,"), "metrics.csv:3: epoch: 3 is not accepted; accepted: 2"),
    "epoch from zero": (("\n1,", "\n0,"), "metrics.csv:2: epoch: 0 is not accepted; accepted: 1"),
    "rate below zero": (("0.005", "-0.005"), "metrics.csv:2: rate: -0.005 is not accepted; accepted: 0 or more"),
    "rmse below zero": ((",3.0,0.005,1.5,1\n2", ",-3.0,0.005,1.5,1\n2"), "metrics.csv:2: validation_rmse: -3.0 is not"),
    "cut off": (("0.005,1.5,1\n3", "0.005,1.5\n3"), "metrics.csv:3: line is cut off or too long: 6 fields"),
    "a NUL": (("-2.0,3.0", "\0,3.0"), "metrics.csv"),
    "a quote": (("-2.0,3.0", '"-2.0,3.0'), "metrics.csv"),
    "a blank line": (("\n2,", "\n\n2,"), "metrics.csv:3: line is cut off or too long: 0 fields"),
    "semicolons": ((",", ";"), "metrics.csv: column 'epoch' is missing"),
}


@pytest.mark.parametrize("name", METRICS)
def test_metrics_that_break_the_contract_are_refused(name, training):
    (old, new), says = METRICS[name]
    path = training / "metrics.csv"
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(DataError, match=says):
        read_training(training)
    assert re.search(says, refusal_of(path))


JOINT_ERRORS = {
    "not a number": ((",2.5,3.5\n", ",nan,3.5\n"), "metrics.csv:2: validation_rmse_LL1: 'nan' is not accepted; acc"),
    "below zero": ((",2.5,3.5\n", ",-2.5,3.5\n"), "metrics.csv:2: validation_rmse_LL1: -2.5 is not .*: 0 or more"),
    "not the mean's": ((",2.5,3.5\n", ",2.5,4.5\n"), "validation_rmse of epoch 1: .*; accepted: the mean .*, 3.5"),
    "of another limb": (("_LL2", "_RL2"), "joints with errors: LL1, RL2 in metrics.csv and LL1, LL2 in run.json are"),
    "of fewer joints": (("validation_rmse_LL2", "more"), "joints with errors: LL1 in metrics.csv and LL1, LL2 in run"),
}


@pytest.fixture
def with_joints(training):
    """The training with the errors of its two joints."""
    path = training / "metrics.csv"
    head, *lines = path.read_text().splitlines()
    joints = ",validation_rmse_LL1,validation_rmse_LL2"
    path.write_text("\n".join([head + joints, *(f"{line},2.5,3.5" for line in lines), ""]))
    return training


def test_errors_of_joints_are_read_and_a_training_may_have_none(with_joints):
    assert read_training(with_joints).joint_errors == {"LL1": (2.5,) * 3, "LL2": (3.5,) * 3}
    assert check(with_joints / "metrics.csv", AGAINST) == "training GRU-LL-s1, 3 epochs"


@pytest.mark.parametrize("name", JOINT_ERRORS)
def test_errors_of_joints_that_break_the_contract_are_refused(name, with_joints):
    (old, new), says = JOINT_ERRORS[name]
    path = with_joints / "metrics.csv"
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(DataError, match=says):
        read_training(with_joints)
    assert re.search(says, refusal_of(path))


@pytest.mark.parametrize("damage", [b"", b"\xff\xfe\x00", b"epoch\n", b"epoch,train_loss"])
@pytest.mark.parametrize("name", ["metrics.csv", "run.json"])
def test_a_damaged_file_of_a_training_is_refused(name, damage, training):
    (training / name).write_bytes(damage)
    with pytest.raises(DataError, match=name):
        read_training(training)
    refusal_of(training / name)


SCORES = {
    "NaN": ((",1.5,", ",nan,"), "walk.csv:2: value: 'nan' is not accepted; accepted: a finite number"),
    "below zero": ((",1.5,", ",-1.5,"), "walk.csv:2: value: -1.5 is not accepted; accepted: 0 or more"),
    "seed as text": ((",0,1,", ",zero,1,"), "walk.csv:2: network_seed: 'zero' is not .*: a whole number"),
    "seed below zero": ((",0,1,", ",-1,1,"), "walk.csv:2: network_seed: -1 is not accepted"),
    "twice": ((",0,2,", ",0,1,"), "walk.csv:4: row: .* is not accepted; accepted: once; it stands in line 2"),
    "unit unknown": (("N m", "Nm"), "walk.csv:2: unit: 'Nm' is not accepted; accepted: N, N m"),
    "metric unknown": ((",rmse,", ",rmse_push_0,"), "walk.csv:2: metric: 'rmse_push_0' is not .*: a name"),
    "unit of another": ((",rmse,", ",r_rmse,"), "walk.csv:2: unit: 'N m' is not accepted; accepted: %"),
    "correlation": ((",rmse,1.5,N m", ",acf_10ms,1.5,-"), "walk.csv:2: value: 1.5 is not .*: 1 or less"),
    "share": ((",rmse,1.5,N m", ",cover,1.5,-"), "walk.csv:2: value: 1.5 is not .*: 1 or less"),
    "no joint": (("LL1", ""), "walk.csv:2: joint: '' is not accepted; accepted: a name"),
    "no method": (("MOB", ""), "walk.csv:2: method: '' is not accepted"),
}


@pytest.mark.parametrize("name", SCORES)
def test_scores_that_break_the_contract_are_refused(name, scores):
    (old, new), says = SCORES[name]
    assert old in scores.read_text()
    scores.write_text(scores.read_text().replace(old, new))
    with pytest.raises(DataError, match=says):
        read_scores(scores)
    assert re.search(says, refusal_of(scores))


def test_sound_scores_are_accepted(scores):
    assert check(scores, AGAINST) == "scores, 4 rows"


def test_a_limb_with_forces_and_torques_has_two_relative_means(scores):
    mean = "walk,ideal,MOB,0,1,V,avg,r_rmse,{},%\n"
    scores.write_text(scores.read_text() + mean.format(4.25) + mean.format(5.22))
    assert len(read_scores(scores)) == 6


KNEE = {"coulomb_nm": 1.0, "static_nm": 2.0, "viscous_nms": 0.0, "load_per_nm": 0.0, "stribeck_rad_s": 0.1,
        "target_rms_nm": 3.0, "left_rms_nm": 1.0}  # fmt: skip
FITS = {
    **refusals(
        {
            "smoothing_rad_s": (0.0, "0.02"),
            "joints": ([],),
            "joints.LL4.coulomb_nm": (-1.0, float("nan")),
            "joints.LL4.stribeck_rad_s": (0.0,),
            "joints.LL4.colour": (1,),
        },
        "smoothing_rad_s joints joints.LL4.static_nm",
    ),
    "joint unknown": (set_at("joints.XX1", KNEE), "joint: 'XX1' is not accepted; accepted: .*LA1"),
}
DAHL = {"breakaway_rad": 0.004, "forward_nm": 1.0, "backward_nm": 2.0, "driving": 0.2, "driven": 0.3,
        "viscous_nms": 0.0, "constant_nm": -1.0, "gain": -0.1, "target_rms_nm": 3.0, "left_rms_nm": 1.0}  # fmt: skip
DAHL_FITS = {
    **refusals(
        {
            "law": ("stribeck",),
            "joints": ([],),
            "joints.LL4.driven": (-1.0, float("nan")),
            "joints.LL4.breakaway_rad": (0.0, 2.0),
            "joints.LL4.colour": (1,),
        },
        "joints joints.LL4.gain",
    ),
    "joint unknown": (set_at("joints.XX1", DAHL), "joint: 'XX1' is not accepted; accepted: .*LA1"),
}
LAWS = {  # file -> what reads it, a sound fit, and what is refused of it
    "MOB-fric.json": (read_friction, {"smoothing_rad_s": 0.02, "joints": {"LL4": KNEE}}, FITS),
    "MOB-fric-dahl.json": (read_dahl, {"law": "dahl", "joints": {"LL4": DAHL}}, DAHL_FITS),
}


@pytest.mark.parametrize(("file", "name"), [(file, name) for file, (*_, refused) in LAWS.items() for name in refused])
def test_a_fit_that_breaks_the_contract_is_refused(file, name, tmp_path, layout):
    read, sound, refused = LAWS[file]
    (change, says), fit, path = refused[name], deepcopy(sound), tmp_path / file
    path.write_text(json.dumps(fit))
    assert check(path, AGAINST) == "fit of 1 joints"
    change(fit)
    path.write_text(json.dumps(fit))
    with pytest.raises(DataError, match=says):
        read(path, layout.actuated)
    assert re.search(says, refusal_of(path))


ACCOUNT = {"job": "train/x", "start_s": 1.0, "end_s": 2.0, "wall_s": 1.0, "cpu_s": 0.5, "peak_mib": 9.0,
           "succeeded": True}  # fmt: skip


@pytest.mark.parametrize(("key", "value"), [
    ("job", ""), ("job", 3), ("start_s", -1.0), ("end_s", 0.5), ("wall_s", "1"), ("cpu_s", float("inf")),
    ("peak_mib", -1), ("succeeded", 1), ("succeeded", None), ("more", 1),
])  # fmt: skip
def test_an_account_that_breaks_the_contract_is_refused(key, value, tmp_path):
    path = tmp_path / "x.json"
    path.write_text(json.dumps(ACCOUNT))
    assert check(path, AGAINST) == "account of train/x"
    path.write_text(json.dumps(ACCOUNT | {key: value}))
    with pytest.raises(DataError, match=rf"x\.json: {key}: .* is not accepted; accepted: "):
        read_account(path)
    assert f"{key}: " in refusal_of(path)


@pytest.mark.parametrize("name", DETECTION_FILES)
def test_what_detectors_find_is_accepted_and_refused_by_its_contract(name, tmp_path):
    path = write_detections(tmp_path)["robot_1"][name]
    rows = path.read_text().splitlines()
    assert check(path, AGAINST) == f"{name} of detectors, {len(rows) - 1} rows"
    path.write_text("\n".join([rows[0], rows[1].replace("LL", ""), *rows[2:]]))
    assert "csv:2: leg: '' is not accepted; accepted: a name" in refusal_of(path)
    path.write_text("\n".join([rows[0], rows[1][: rows[1].rindex(",")], *rows[2:]]))
    assert "csv:2: line is cut off" in refusal_of(path)


DETECTIONS = {
    "below zero": ("collisions", ("0.4\n", "-0.4\n"), "swing_share: -0.4 is not accepted; accepted: 0 or more"),
    "ends early": ("collisions", (",2.078,", ",1.0,"), "start_s: 2.0 is not accepted; accepted: at most end_s, 1.0"),
    "interval": ("promises", (",300\n", ",1\n"), "low: 12.0 is not accepted; accepted: at most high, 1.0"),
    "part": ("swings", (",calibration,", ",somewhere,"), "part: 'somewhere' is not accepted; accepted: calibration"),
    "text": ("thresholds", (",1.5,", ",much,"), "value: 'much' is not accepted"),
}


@pytest.mark.parametrize("name", DETECTIONS)
def test_rows_of_detectors_that_break_the_contract_are_refused(name, tmp_path):
    file, (old, new), says = DETECTIONS[name]
    path = write_detections(tmp_path)["robot_1"][file]
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    assert f"csv:2: {says}" in refusal_of(path)
