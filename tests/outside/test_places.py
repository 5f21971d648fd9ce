"""A file of results that is not the one of its place is refused before a run, and by a check."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from made_notes import training_note
from made_places import LEVEL, SCENARIO, Change, estimated, note_of, written
from safetensors.numpy import save_file

from mobnet.agreement import check_agreement
from mobnet.core.columns import Score, torque_columns
from mobnet.core.errors import DataError
from mobnet.core.metrics import unit_of_metric
from mobnet.core.store import file_of, read_array, write_array
from mobnet.estimation.kinds.friction import Options, fitted_joints
from mobnet.evaluation.measure.changed import FLAGGED, FREE, KNOWN
from mobnet.evaluation.measure.scores import limb_values
from mobnet.evaluation.measure.spread import COVER
from mobnet.evaluation.number.files import write_csv
from mobnet.learning.deployed.weights import NOTE, shapes
from mobnet.learning.features import limb_inputs
from mobnet.plan.runs import Files
from mobnet.settings.catalogue import Catalogue
from mobnet.settings.load import load_settings


def refused(path: Path, files: Files) -> str:
    """Return the line with which a file is refused."""
    with pytest.raises(DataError) as found:
        check_agreement([path], files)
    assert str(found.value).startswith(f"{path}: ")
    return str(found.value)


def put(key: str, value: Any) -> Change:
    """Return a change of a note that sets the value of a key."""
    return lambda note: note.update({key: value})


ARRAYS: dict[str, tuple[str, Change, str]] = {
    "scenario": ("recordings", put("scenario", "forward_walk"), "scenario: 'forward_walk' is not"),
    "no scenario": ("recordings", lambda note: note.pop("scenario"), "scenario: 'nothing' is not"),
    "level": ("recordings", put("level", "ideal"), "level: 'ideal' is not"),
    "seed": ("residuals", put("seed", 7), "seed: 7 is not accepted; accepted: 101"),
    "rate": ("residuals", put("rate_hz", 500.0), "rate_hz: 500.0 is not"),
    "terrain": ("recordings", put("terrains", ["gravel"]), "terrains: 'gravel' is not"),
    "gain": ("residuals", put("gain_hz", 50.0), "gain_hz: 50.0 is not"),
    "rows": (
        "recordings",
        put("rows", 12000),
        "rows: '12000 rows, 10000 in segments' is not",
    ),
    "segments": ("recordings", put("segments", [[0, 100]]), "rows: '10000 rows, 100 in segments' is not"),
    "collisions": ("recordings", put("clearance_min_m", -0.03), "self_collisions: 0 is not accepted; accepted: those"),
    "clearance": ("recordings", put("clearance_min_m", 60.0), "clearance_min_m: 60.0 is not accepted; accepted: less"),
    "kind": ("recordings", put("columns", [{"name": "r.LL1", "unit": "-", "frame": "-"}]), "columns: ['r'] is not"),
    "columns": ("estimates/MOB-Net/n0", lambda note: note["columns"].pop(), "columns: 'std.RL6' is missing"),
    "mass": ("residuals", put("nominal_mass_ratio", 1.0), "nominal_mass_ratio: 1.0 is not"),
    "method": ("estimates/MOB-Net/n0", put("method", "FTS-e2e"), "method: 'FTS-e2e' is not accepted; accepted: 'MOB-N"),
    "network": (
        "estimates/MOB-Net/n0",
        put("networks", {"LL": "MOB-Net-RL-s0"}),
        "networks.LL: 'MOB-Net-RL-s0' is not",
    ),
}


@pytest.mark.parametrize("name", ARRAYS)
def test_the_note_of_another_array_is_refused(name: str, files: Files) -> None:
    kind, change, says = ARRAYS[name]
    networks = {limb: folder.name for limb, folder in files.networks("MOB-Net", 0, SCENARIO, LEVEL).items()}
    more: dict[str, Any] = {
        "recordings": {"terrains": ["checks"]},
        "residuals": {"gain_hz": files.settings.observer.gain_hz, "nominal_mass_ratio": 0.9},
    }.get(kind, {"method": "MOB-Net", "networks": networks})
    path, note = note_of(files, kind, **more)
    check_agreement([written(path, note)], files)
    change(note)
    assert says in refused(written(path, note), files)


@pytest.mark.parametrize(
    ("folder", "says"),
    [
        ("MOB-Nett/n0", "folder of the method: 'MOB-Nett' is not accepted; accepted: MOB-Net"),
        ("MOB-Net/n7", "folder of the seed of MOB-Net: 'n7' is not accepted; accepted: n0"),
        ("MOB-Net-gray/n0", "folder of the test of MOB-Net-gray: 'walk_test/ideal' is not accepted"),
    ],
)
def test_an_estimate_that_no_job_makes_is_refused(folder: str, says: str, files: Files) -> None:
    path, note = note_of(files, f"estimates/{folder}")
    if "gray" in folder:
        path = path.parents[1] / "ideal" / path.name
    assert says in refused(written(path, note), files)


def test_a_residual_of_other_rows_than_its_recording_is_refused(files: Files) -> None:
    written(*note_of(files, "recordings"))
    path, note = note_of(files, "residuals", gain_hz=files.settings.observer.gain_hz, nominal_mass_ratio=0.9)
    check_agreement([written(path, note)], files)
    assert "rows: 9000 is not accepted; accepted: 10000" in refused(
        written(path, note | {"rows": 9000, "segments": [[0, 9000]]}), files
    )


def test_factors_that_are_not_those_of_the_networks_are_refused(files: Files) -> None:
    names = {limb: folder.name for limb, folder in files.networks("MOB-Net", 0, SCENARIO, LEVEL).items()}
    path, note = note_of(files, "estimates/MOB-Net/n0", method="MOB-Net", networks=names)
    for limb in names:
        weights(files, "MOB-Net", limb)
    scales = dict.fromkeys(estimated(files), 1.0)
    check_agreement([written(path, note | {"std_scale": scales})], files)
    for wrong in ({}, scales | {"LL1": 55.0}, scales | {"XX1": 1.0}):
        assert "std_scale: " in refused(written(path, note | {"std_scale": wrong}), files)


def weights(files: Files, method: str, limb: str, change: Change = lambda note: None, **values: float) -> Path:
    """Write weights of a method's network, all ones or the value that is given for a tensor."""
    training, layout = files.catalogue.training(method, limb), files.settings.layout
    inputs = limb_inputs(layout, training.network).names
    joints = [joint for group in training.network.joints for joint in layout.limb(group)]
    row = training.network.model_dump(mode="json", exclude_defaults=True)
    name = f"{method}-{limb}-s0"
    note = {
        "name": name,
        "limb": limb,
        "joints": joints,
        "inputs": list(inputs),
        "std_min": training.learning.std_min,
        "network": row,
    }
    change(note)
    tensors = {
        k: np.full(shape, values.get(k, 1.0), np.float32)
        for k, shape in shapes(training.network, len(inputs), len(joints)).items()
    }
    path = files.network(method, limb, 0) / "weights.safetensors"
    path.parent.mkdir(parents=True, exist_ok=True)
    save_file(tensors, path, {NOTE: json.dumps(note)})
    return path


WEIGHTS: dict[str, tuple[str, Change, str]] = {
    "of another training": ("MOB-Net", put("name", "FTS-e2e-LL-s0"), "name: 'FTS-e2e-LL-s0' is not"),
    "other data": ("MOB-Net", lambda note: note["network"].update(data="walk_plain"), "network.data: 'walk_plain'"),
    "inputs in another order": ("MOB-Net", lambda note: note["inputs"].reverse(), "inputs.0: "),
    "no gain of its inputs": ("GRU-spectral", lambda note: note["network"].pop("input_gain"), "network.input_gain: 'n"),
}


@pytest.mark.parametrize("name", WEIGHTS)
def test_weights_of_another_network_are_refused(name: str, files: Files) -> None:
    method, change, says = WEIGHTS[name]
    check_agreement([weights(files, method, "LL")], files)
    assert says in refused(weights(files, method, "LL", change), files)


TENSORS: dict[str, tuple[dict[str, Any], str]] = {
    "cell": ({"cell.weight_hh_l0": 0.0}, "tensor 'cell.weight_hh_l0': every entry: 0.0 is not"),
    "mean": ({"input.mean": 57.0}, "tensor 'input.mean': q.LL1: 57.0 is not accepted; accepted: -"),
}


@pytest.mark.parametrize("name", TENSORS)
def test_weights_that_no_training_gives_are_refused(name: str, files: Files) -> None:
    values, says = TENSORS[name]
    assert says in refused(weights(files, "MOB-Net", "LL", **values), files)


RUNS: dict[str, tuple[Change, str]] = {
    "parameters": (put("parameters", 1), "parameters: 1 is not accepted; accepted: 83712"),
    "loss": (lambda note: note["settings"].update(loss="mse"), "settings.loss: 'mse' is not"),
    "a setting more": (lambda note: note["settings"].update(momentum=0.9), "settings.momentum: 0.9 is not"),
    "joints": (lambda note: note["calibration"].update(joints=["LL9"] * 6), "calibration.joints: "),
    "name": (put("name", "GRU-RL-s0"), "name: 'GRU-RL-s0' is not accepted; accepted: 'GRU-LL-s0'"),
    "method": (put("method", "LSTM"), "method: 'LSTM' is not"),
    "limb": (put("limb", "RL"), "limb: 'RL' is not"),
    "seed": (put("seed", 1), "seed: 1 is not"),
    "target": (put("target", "external"), "target: 'external' is not"),
}


@pytest.mark.parametrize("name", RUNS)
def test_the_note_of_another_training_is_refused(name: str, files: Files) -> None:
    change, says = RUNS[name]
    row = files.catalogue.training("GRU", "LL").network.model_dump(mode="json", exclude_defaults=True)
    training = files.catalogue.training("GRU", "LL")
    learning = training.learning.model_dump(mode="json", exclude_defaults=True)
    sizes = {"epochs": training.epochs, "epoch_samples": training.epoch_samples}
    joints = {"joints": [f"LL{k}" for k in range(1, 7)], "scale": [1.0] * 6, "likelihood_scale": [1.0] * 6}
    fit = {"coverage": [[0.5] * 6], "nll": [1.0] * 6, "crps": [0.2] * 6}
    note = training_note(
        "GRU-LL-s0", [-1.0, -2.0], settings={"network": row, **learning, **sizes}, parameters=83712,
        calibration={"shares": [0.5], **joints, "before": fit, "after": fit},
    )  # fmt: skip
    path = files.network("GRU", "LL", 0) / "run.json"
    check_agreement([written(path, note)], files)
    change(note)
    assert says in refused(written(path, note), files)


def fit_of(files: Files) -> dict[str, Any]:
    """Return a sound fit of MOB-fric."""
    row = files.catalogue.method("MOB-fric")
    options = Options.model_validate(row.options)
    joints = fitted_joints(files.settings.layout, options, [files.catalogue.network("MOB-fric", x) for x in row.fitted])
    numbers = {"coulomb_nm": 1.0, "static_nm": 1.0, "viscous_nms": 1.0, "load_per_nm": 0.0, "stribeck_rad_s": 0.1}
    return {"smoothing_rad_s": options.smoothing_rad_s, "joints": {joint: dict(numbers) for joint in joints}}


FITS: dict[str, tuple[Change, str]] = {
    "smoothing": (put("smoothing_rad_s", 0.2), "smoothing_rad_s: 0.2 is not accepted; accepted: 0.02"),
    "a joint is gone": (lambda note: note["joints"].pop("LL4"), "joints: 'LL4' is missing"),
    "load": (lambda note: note["joints"]["LL4"].update(load_per_nm=0.1), "joints.LL4: load: 0.1 is not accepted; acc"),
    "worse than nothing": (lambda n: n["joints"]["LL4"].update(left_rms_nm=9.0), "left_rms_nm: 9.0 is not"),
    "velocity": (lambda n: n["joints"]["LL4"].update(stribeck_rad_s=0.33), "stribeck_rad_s: 0.33 is not"),
    "more load than there is": (
        lambda note: note["joints"]["LL4"].update(load_per_nm=2.6),
        "load_per_nm: 2.6 is not",
    ),
    "a term that no joint has": (
        lambda note: [row.update(viscous_nms=0.0) for row in note["joints"].values()],
        "joints: viscous: 0.0 is not accepted; accepted: above 0 for some joint",
    ),
    "huge": (lambda note: note["joints"]["LL4"].update(viscous_nms=1e15), "viscous_nms: 1000000000000000.0 is not"),
}


@pytest.mark.parametrize("name", FITS)
def test_a_fit_that_the_method_does_not_make_is_refused(name: str, files: Files) -> None:
    change, says = FITS[name]
    note, path = fit_of(files), files.results / "fits" / "MOB-fric.json"
    check_agreement([written(path, note)], files)
    change(note)
    assert says in refused(written(path, note), files)


def test_friction_that_does_not_fall_with_the_speed_is_a_sound_fit(files: Files) -> None:
    """Gears of the surrogate robots are such: no joint has static friction beyond its Coulomb friction."""
    note = fit_of(files)
    for row in note["joints"].values():
        row["static_nm"] = 0.0
    check_agreement([written(files.results / "fits" / "MOB-fric.json", note)], files)


def scores_of(
    files: Files, scenario: str = SCENARIO, level: str = LEVEL, metric: str = "rmse", size: float = 1.0
) -> list[Score]:
    """Return a metric of every run of a test at a level, from a size on, on all joints that it estimates."""
    layout, runs = files.settings.layout, files.runs_of(scenario, level)
    values = {joint: size * (1.0 + k) for k, joint in enumerate(layout.names)}
    return [
        Score(scenario, run.level, run.method, run.network_seed, run.test_seed, limb, joint, metric, value, own)
        for run in runs
        for held in [files.catalogue.estimated(run.method, run.scenario, run.level)]
        for limb, joint, value, unit in limb_values(layout, {joint: values[joint] for joint in held})
        for own in [unit_of_metric(metric, unit)]
        if limb not in run.repeated
    ]


def test_every_metric_that_is_measured_is_a_sound_row(tmp_path: Path) -> None:
    """The shares of changed robots were in no list of names."""
    files, place = Files(Catalogue(load_settings(overrides={"scale": "smoke"})), tmp_path), ("changed_walk", "robots")
    rows = scores_of(files, *place) + [
        row for metric in (KNOWN, FREE, FLAGGED) for row in scores_of(files, *place, metric, 0.01)
    ]
    (path,) = files.scores([place])
    write_csv(path, list(vars(rows[0])), [tuple(vars(row).values()) for row in rows])
    check_agreement([path], files)
    rows += scores_of(files, *place, COVER, 0.01)
    write_csv(path, list(vars(rows[0])), [tuple(vars(row).values()) for row in rows])
    assert "metric cover: test of section sigma: 'changed_walk' is not accepted" in refused(path, files)


SCORES: dict[str, tuple[int, dict[str, Any], str]] = {
    "scenario": (0, {"scenario": "knee_swing"}, "line 2: scenario: 'knee_swing' is not"),
    "level": (0, {"level": "none"}, "line 2: level: 'none' is not"),
    "method": (0, {"method": "MOBB"}, "line 2: method: 'MOBB' is not"),
    "test seed": (0, {"test_seed": 7}, "line 2: test_seed: 7 is not accepted; accepted: 101"),
    "network seed": (0, {"network_seed": 9}, "line 2: network_seed: 9 is not"),
    "limb": (0, {"limb": "XX"}, "line 2: limb: 'XX' is not"),
    "joint": (0, {"joint": "RA1"}, "line 2: joint: 'RA1' is not"),
    "metric": (0, {"metric": "rmse_push_0"}, "line 2: metric: 'rmse_push_0' is not"),
    "unit": (0, {"unit": "N"}, "line 2: unit: 'N' is not"),
    "unit of a share": (0, {"metric": "r_rmse"}, "line 2: unit: 'N m' is not accepted; accepted: %"),
    "correlation": (0, {"metric": "acf_10ms", "unit": "-", "value": 1.5}, "line 2: value of acf_10ms: 1.5 is not"),
    "no push": (0, {"metric": "rmse_pushed"}, "metric rmse_pushed: test with a window around pushes: 'walk_test' is"),
    "share": (0, {"metric": "cover", "unit": "-", "value": 1.5}, "line 2: value of cover: 1.5 is not"),
    "average": (6, {"value": 99.0}, "metric rmse: avg: 99.0 is not accepted; accepted: 9.5, the mean"),
}


@pytest.mark.parametrize("name", SCORES)
def test_rows_that_are_not_of_the_test_are_refused(name: str, files: Files) -> None:
    line, change, says = SCORES[name]
    (path,), rows = files.scores([(SCENARIO, LEVEL)]), [tuple(vars(row).values()) for row in scores_of(files)]
    names = list(vars(scores_of(files)[0]))
    write_csv(path, names, rows)
    check_agreement([path], files)
    rows[line] = tuple((dict(zip(names, rows[line], strict=True)) | change).values())
    write_csv(path, names, rows)
    assert says in refused(path, files)


def test_a_run_or_a_joint_without_an_error_is_refused(files: Files) -> None:
    (path,), rows = files.scores([(SCENARIO, LEVEL)]), [tuple(vars(row).values()) for row in scores_of(files)]
    names = list(vars(scores_of(files)[0]))
    method = rows[0][2]
    write_csv(path, names, [row for row in rows if row[2] != method])
    assert f"rows: {{'level': '{LEVEL}', 'method': {method!r}" in refused(path, files)
    write_csv(path, names, [row for row in rows if row[6] != "LL3"])
    assert "limb LL, metric rmse: 'LL3' is missing" in refused(path, files)
    write_csv(path, names, [row for row in rows if row[6] != "avg"])
    assert "limb LL, metric rmse: 'avg' is missing; accepted: " in refused(path, files)
    write_csv(path, names, [row for row in rows if row[5] != "RL"])
    assert "'limb': 'RL', 'metric': 'rmse'} is missing; accepted: every limb" in refused(path, files)


def test_the_array_of_another_recording_is_refused(files: Files, tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    columns = torque_columns(files.settings.layout, ["tau_ext"], ["LL1", "LL2"])
    for name in ("one", "other"):
        write_array(tmp_path / name, rng.normal(size=(500, 2)), columns, {"rate_hz": 1000.0})
        read_array(tmp_path / name)
    file_of(tmp_path / "one", ".parquet").write_bytes(file_of(tmp_path / "other", ".parquet").read_bytes())
    with pytest.raises(DataError, match=r"one.parquet: hash of the footer: .* as one.json says"):
        read_array(tmp_path / "one")


def test_a_file_elsewhere_or_of_no_plan_is_left_alone(files: Files, tmp_path: Path) -> None:
    path, note = note_of(files, "recordings")
    note["scenario"] = "of a lab"
    other = written(tmp_path.parent / "lab" / "s1.json", note)
    unknown = written(path.parents[2] / "lab" / LEVEL / "s1.json", note)
    check_agreement([other, unknown, tmp_path / "recordings" / "missing.json"], files)
