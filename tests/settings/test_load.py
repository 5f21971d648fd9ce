"""A configuration is accepted whole, or refused in one line for each fault: file, key, value and what is accepted."""

import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml

from mobnet.core.errors import ConfigError
from mobnet.settings.load import CONFIGS, load_settings, read_yaml
from mobnet.settings.settings import Settings

ACCEPTED = "is not accepted; accepted: "
EXPECTED = "(key is missing|the path of a YAML file is expected)"
MISSING = ("config.seed", "config.robot", "data.pushes", "tests.tests", "scales.scales")
OF_A_PUSH, SETS = ("pause_s", "force_n", "point", "direction"), ("walk", "walk_plain", "motion")


def nested(key: str, value: object) -> dict[str, Any]:
    """Return a dotted key with its value as nested mappings."""
    first, _, rest = key.partition(".")
    return {first: nested(rest, value) if rest else value}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the repository's configuration."""
    return shutil.copytree(CONFIGS, tmp_path / "configs")


@pytest.mark.parametrize("scale", ["smoke", "default", "paper"])
def test_every_scale_is_accepted(scale: str) -> None:
    assert load_settings(overrides={"scale": scale}).scale == scale


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("observer.gain", 3.0, "methods.yaml: observer: key: 'gain' is not accepted; accepted: gain_hz"),
        ("colour", "red", "colour: key: 'colour' is not accepted; accepted: claims, "),
        ("scales.smoke.test.shard_s", -10.0, "scales.yaml: scales.smoke.test.shard_s: -10.0 is not .*greater"),
        ("scales.default.experiments.sweep.epochs", 0, "default.experiments.sweep.epochs: 0 is not accepted; .*1"),
        ("scenarios.walk_test.commands", "sprint", "walk_test.commands.*: 'sprint' is not .*'random' or 'stand'"),
        ("scenarios.knee_swing.commands", {"hop": 1}, "knee_swing.commands.*: key: 'hop' is not accepted"),
        ("scenarios.forward_walk.commands.duration_s", -0.7, r"commands.*duration_s: -0.7 is not accepted"),
        ("rates.plant_hz", "fast", "plant.yaml: rates.plant_hz: 'fast' is not accepted; .*valid number"),
        ("rates.plant_hz", True, "rates.plant_hz: True is not accepted; .*valid number"),
        ("levels.ideal.base_state", "guessed", "'guessed' is not accepted; input should be 'true_state' or 'sensed'"),
        ("commands.step_x_m", [0.2, -0.1], "data.yaml: commands.step_x_m: the lower end must come first"),
        ("pushes.torso.at_s", [], "pushes.torso.at_s: .* is not accepted"),
        ("pushes.torso.joint", "LL3", "pushes.torso: accepted: `point`, `force_n` and `direction`, or `joint` and"),
        ("networks.LL.cell", "CfC", "networks.LL.cell: 'CfC' is not accepted; input should be 'GRU', 'LSTM', 'RNN'"),
        ("learning.precision", "half", "precision: 'half' is not accepted; .* 'auto', 'float32' or 'bfloat16'"),
        ("methods.MOB-Net.target", "all", "MOB-Net.target: 'all' is not accepted; .* 'uncertainty' or 'external'"),
        ("methods.TCN.network.head", None, "methods.TCN.network: head is missing; a cell TCN needs hidden"),
        ("methods.GRU.network.foo", 1, "methods.GRU.network.foo: key: 'foo' is not accepted; accepted: Q, T, cell, "),
        ("methods.LSTM.learning.foo", 1, "methods.LSTM.learning.foo: key: 'foo' is not accepted; accepted: batch_"),
        ("methods.LSTM.network.spectral", True, "methods.LSTM.network: a cell LSTM with `spectral` is not accepted"),
        ("methods.MOB.limbs", ["LL"], "methods.MOB: `target` and `limbs` are accepted together only"),
        ("scale", "huge", f"scale: scale: 'huge' {ACCEPTED}default, paper, smoke"),
        ("methods.MOB-Net.limbs", ["LL", "tail"], f"methods.MOB-Net.limbs: network: 'tail' {ACCEPTED}LA, LL"),
        ("methods.MOB-fric.fitted", ["tail"], f"methods.MOB-fric.fitted: network: 'tail' {ACCEPTED}LA, LL"),
        ("methods.MOB-fric-BPF.of", "magic", f"MOB-fric-BPF.of: method that runs.*: 'magic' {ACCEPTED}"),
        ("scenarios.walk_test.terrain", ["flat", "ice"], f"walk_test.terrain: terrain: 'ice' {ACCEPTED}checks, flat"),
        ("scenarios.knee_swing.pushes", ["elbow"], f"knee_swing.pushes: push: 'elbow' {ACCEPTED}hip_pitch"),
        ("scenarios.motion_test.motion", "dance", f"motion_test.motion: motion: 'dance' {ACCEPTED}random_m"),
        ("scenarios.hand_load_10.draws", "hops", f"hand_load_10.draws: scenario: 'hops' {ACCEPTED}forward_w"),
        ("pushes.torso.point", "tail", f"pushes.torso.point: point: 'tail' {ACCEPTED}left_hand, .*left_sole"),
        ("pushes.hip_pitch.joint", "LL9", f"pushes.hip_pitch.joint: motor: 'LL9' {ACCEPTED}"),
        ("tests.stroll", {"ideal": ["MOB"]}, f"tests.yaml: tests: scenario: 'stroll' {ACCEPTED}forward_walk"),
        ("tests.walk_test.perfect", ["MOB"], f"tests.walk_test: level: 'perfect' {ACCEPTED}all_uncertainty"),
        ("tests.walk_test.all_uncertainty", ["MOB"], f"table_07.rows: method of test .*'FTS-e2e' {ACCEPTED}MOB\n"),
        ("evaluation.figure_05.joint", "LL9", f"evaluation.yaml: evaluation.figure_05.joint: joint: 'LL9' {ACCEPTED}"),
        ("evaluation.figure_05.scenario", "dance", f"figure_05.scenario: test: 'dance' {ACCEPTED}"),
        ("evaluation.figure_05.panels.ideal", ["magic"], f"figure_05.panels.ideal: method: 'magic' {ACCEPTED}"),
        ("evaluation.figure_06.scenario", "walk_test", f"figure_06.scenario: test with.*: 'walk_test' {ACCEPTED}"),
        ("evaluation.error_budget.joints", ["LL9"], f"error_budget.joints: limb or joint: 'LL9' {ACCEPTED}"),
        ("evaluation.windows.stroll", {"before_s": 0.0, "after_s": 0.1}, f"windows: test: 'stroll' {ACCEPTED}"),
        ("evaluation.figure_20.samples", "shares", f"figure_20.samples: sweep: 'shares' {ACCEPTED}data_parts, hidden"),
        ("training_sets.walk.level", "none", f"data.yaml: training_sets.walk.level: level: 'none' {ACCEPTED}all_"),
        ("training_sets.motion.scenario", "nap", f"training_sets.motion.scenario: scenario: 'nap' {ACCEPTED}"),
        ("training_sets.motion.sizes.tiny", {"shards": 1, "shard_s": 1.0}, f"sizes: scale: 'tiny' {ACCEPTED}"),
        ("networks.tail", {"data": "walk", "experiment": "sweep", "horizon_steps": 1, "cell": "constant"},
         f"networks.yaml: networks: network of the robot: 'tail' {ACCEPTED}LA"),
        ("networks.LL.data", "walks", f"networks.yaml: networks.LL.data: training set: 'walks' {ACCEPTED}motion"),
    ],
)  # fmt: skip
def test_a_fault_is_one_line_with_file_key_value_and_accepted(key: str, value: object, message: str) -> None:
    with pytest.raises(ConfigError, match=message) as caught:
        load_settings(overrides=nested(key, value))
    assert all(line.startswith(str(CONFIGS)) for line in str(caught.value).splitlines())


def test_all_faults_of_all_files_are_told_at_once() -> None:
    bad = {"observer": {"gain_hz": 0.0}, "plant": {"contact_friction": -1.0, "springs": 2}, "seed": "x"}
    with pytest.raises(ConfigError) as caught:
        load_settings(overrides=bad)
    places = [line.split(": ")[1] for line in str(caught.value).splitlines()]
    assert sorted(places) == ["observer.gain_hz", "plant", "plant.contact_friction", "seed"]


def test_the_rows_of_a_table_are_run_and_printed_and_have_windows(settings: Settings) -> None:
    row = settings.evaluation.tables["table_05"].rows[0].model_dump()
    for change, message in (
        ({"scenario": "walk_test", "level": "ideal"}, f"level of test walk_test: 'ideal' {ACCEPTED}all_uncertainty"),
        ({"methods": ["MOB-fric"]}, f"method of test forward_walk, ideal: 'MOB-fric' {ACCEPTED}MOB$"),
        ({"metric": "rmse_pushed"}, f"test with a window around pushes: 'forward_walk' {ACCEPTED}hand_load_10"),
        ({"paper": "rows.ideal"}, f"paper: 'rows.ideal' {ACCEPTED}all_uncertainty, ideal, sensor_noise"),
    ):
        with pytest.raises(ConfigError, match=message):
            load_settings(overrides=nested("evaluation.tables.table_05.rows", [{**row, **change}]))


@pytest.mark.parametrize(
    ("place", "message"),
    [
        *((place, rf"{place.split('.')[1]}: {EXPECTED}") for place in MISSING),
        # a push without a pause and without times would never end
        *((f"data.pushes.torso.{key}", r"data\.yaml: pushes\.torso: accepted: `p") for key in OF_A_PUSH),
        *((f"data.training_sets.{name}.sizes.smoke", rf"\.{name}\.sizes: scale is missing: smoke") for name in SETS),
    ],
)  # fmt: skip
def test_what_is_missing_is_named(folder: Path, place: str, message: str) -> None:
    part, *above, key = place.split(".")
    values = section = read_yaml(folder / f"{part}.yaml")
    for name in above:
        section = section[name]
    del section[key]
    (folder / f"{part}.yaml").write_text(yaml.safe_dump(values))
    with pytest.raises(ConfigError, match=message):
        load_settings(folder)


def test_a_section_that_stands_in_two_files_is_refused(folder: Path) -> None:
    with (folder / "walking.yaml").open("a") as file:
        file.write("\nobserver: {gain_hz: 100.0}\n")
    with pytest.raises(ConfigError, match=r"methods\.yaml: observer: stands in .*walking\.yaml already"):
        load_settings(folder)


def test_a_file_that_is_missing_or_no_mapping_is_named(tmp_path: Path) -> None:
    for name, text, message in (("list", "[1, 2]", "a mapping is expected, found list"), ("bad", "a: [1", "not YAML")):
        (tmp_path / f"{name}.yaml").write_text(text)
        with pytest.raises(ConfigError, match=rf"{name}\.yaml: {message}"):
            read_yaml(tmp_path / f"{name}.yaml")
    with pytest.raises(ConfigError, match=r"no\.yaml: file is missing"):
        read_yaml(tmp_path / "no.yaml")
