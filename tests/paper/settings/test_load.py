"""A configuration is accepted whole, or refused in one line for each fault: file, key, value and what is accepted."""

import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml

from experiments.settings.load import PARTS, load_settings
from experiments.settings.settings import Settings
from mobnet.core.errors import ConfigError
from mobnet.formats.reading import read_yaml
from mobnet.settings.lab import CONFIGS

ACCEPTED = "is not accepted; accepted: "
EXPECTED = "(key is missing; accepted: |None is not accepted; accepted: the path of a YAML file)"
MISSING = tuple(f"{part}.{section}" for part, sections in PARTS.items() for section in sections)
OF_A_PUSH, SETS = ("pause_s", "force_n", "point", "direction"), ("walk", "walk_plain", "motion")


def nested(key: str, value: object) -> dict[str, Any]:
    """Return a dotted key with its value as nested mappings."""
    first, _, rest = key.partition(".")
    return {first: nested(rest, value) if rest else value}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the repository's configuration."""
    return shutil.copytree(CONFIGS, tmp_path / "configs")


@pytest.mark.parametrize("scale", ["smoke", "quick", "default", "paper"])
def test_every_scale_is_accepted(scale: str) -> None:
    assert load_settings(overrides={"scale": scale}).scale == scale


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("observer.gain", 3.0, "observer.gain: key: 'gain' is not accepted; accepted: gain_hz, torque"),
        ("colour", "red", "colour: key: 'colour' is not accepted; accepted: robotlog, recording, "),
        ("scales.smoke.test.shard_s", -10.0, "scales.smoke.test.shard_s: -10.0 is not .*accepted: a number from 1"),
        ("scales.default.experiments.sweep.epochs", 0, "default.experiments.sweep.epochs: 0 is not accepted; .* 1 to"),
        ("scenarios.walk_test.commands", "sprint", "walk_test.commands: 'sprint' is not .*'uniform', 'stand' or a li"),
        ("scenarios.knee_swing.commands", {"hop": 1}, "knee_swing.commands.hop: key: 'hop' is not accepted"),
        ("scenarios.forward_walk.commands.duration_s", -0.7, r"commands.duration_s: -0.7 is not accepted"),
        ("rates.plant_hz", "fast", "rates.plant_hz: 'fast' is not accepted; accepted: a number from 100"),
        ("rates.plant_hz", True, "rates.plant_hz: True is not accepted; accepted: a number"),
        ("levels.ideal.base_state", "guessed", "'guessed' is not accepted; accepted: 'true_state', 'sensed'"),
        ("commands.step_x_m", [0.2, -0.1], r"step_x_m: .* is not accepted; accepted: two numbers, the lower one first"),
        ("pushes.torso.at_s", [], "pushes.torso.at_s: .* is not accepted"),
        ("pushes.torso.joint", "LL3", "pushes.torso: .*accepted: `point`, `force_n` and `direction`, or `joint` and"),
        ("networks.LL.cell", "CfC", "networks.LL.cell: 'CfC' is not accepted; accepted: 'GRU', 'LSTM', 'RNN'"),
        ("learning.precision", "half", "precision: 'half' is not accepted; .* 'auto', 'float32', 'bfloat16'"),
        ("methods.MOB-Net.target", "all", "MOB-Net.target: 'all' is not .* 'uncertainty', 'external' or null"),
        ("methods.TCN.network.head", None, "methods.TCN.network: sizes hidden, .* accepted: hidden, .*, head"),
        ("methods.GRU.network.foo", 1, "methods.GRU.network.foo: key: 'foo' is not accepted; accepted: dropout, "),
        ("methods.LSTM.learning.foo", 1, "methods.LSTM.learning.foo: key: 'foo' is not accepted; accepted: loss, "),
        ("methods.LSTM.network.spectral", True, "methods.LSTM.network: spectral: true is not accepted for a cell LSTM"),
        ("methods.MOB.limbs", ["LL"], "methods.MOB: `target` or `limbs` alone is not accepted"),
        ("scale", "huge", f"scale: 'huge' {ACCEPTED}default, paper, quick, smoke"),
        ("methods.MOB-Net.limbs", ["LL", "tail"], f"methods.MOB-Net.limbs.1: network: 'tail' {ACCEPTED}LA, LL"),
        ("methods.MOB-fric.fitted", ["tail"], f"methods.MOB-fric.fitted.0: network: 'tail' {ACCEPTED}LA, LL"),
        ("methods.MOB-fric-BPF.of", "magic", f"MOB-fric-BPF.of: method that runs.*: 'magic' {ACCEPTED}"),
        ("scenarios.walk_test.terrain", ["flat", "ice"], f"walk_test.terrain.1: terrain: 'ice' {ACCEPTED}checks, flat"),
        ("scenarios.knee_swing.pushes", ["elbow"], f"knee_swing.pushes.0: push: 'elbow' {ACCEPTED}hand_held"),
        ("scenarios.motion_test.motion", "dance", f"motion_test.motion: 'dance' {ACCEPTED}random_m"),
        ("scenarios.hand_load_10.draws", "hops", f"hand_load_10.draws: scenario: 'hops' {ACCEPTED}hip_pitch_step"),
        ("pushes.torso.point", "tail", f"pushes.torso.point: 'tail' {ACCEPTED}.*torso, .*left_hand"),
        ("pushes.hip_pitch.joint", "LL9", f"pushes.hip_pitch.joint: motor: 'LL9' {ACCEPTED}"),
        ("evaluation.figure_05.joint", "LL9", f"evaluation.figure_05.joint: joint of a leg: 'LL9' {ACCEPTED}"),
        ("evaluation.figure_05.scenario", "dance", f"figure_05.scenario: 'dance' {ACCEPTED}"),
        ("evaluation.figure_05.panels.ideal", ["magic"], f"figure_05.panels.ideal.0: method: 'magic' {ACCEPTED}"),
        ("evaluation.figure_06.scenario", "walk_test", f"figure_06.scenario: test with.*: 'walk_test' {ACCEPTED}"),
        ("evaluation.error_budget.joints", ["LL9"], f"error_budget.joints.0: limb or joint: 'LL9' {ACCEPTED}"),
        ("evaluation.windows.stroll", {"before_s": 0.0, "after_s": 0.1},
         f"windows.stroll: scenario with pushes: 'stroll' {ACCEPTED}"),
        ("evaluation.figure_20.samples", "shares", f"figure_20.samples: sweep: 'shares' {ACCEPTED}data_parts, data_s"),
        ("training_sets.walk.level", "none", f"training_sets.walk.level: 'none' {ACCEPTED}"),
        ("training_sets.motion.scenario", "nap", f"training_sets.motion.scenario: 'nap' {ACCEPTED}"),
        ("training_sets.motion.sizes.tiny", {"shards": 1, "shard_s": 1.0}, f"sizes.tiny: scale: 'tiny' {ACCEPTED}"),
        ("networks.tail", {"data": "walk", "experiment": "sweep", "horizon_steps": 1, "cell": "constant"},
         f"networks.tail: network of the robot: 'tail' {ACCEPTED}LA"),
        ("networks.LL.data", "wolks", f"networks.LL.data: training set: 'wolks' {ACCEPTED}walk, "),
    ],
)  # fmt: skip
def test_a_fault_is_one_line_with_file_key_value_and_accepted(key: str, value: object, message: str) -> None:
    with pytest.raises(ConfigError, match=message) as caught:
        load_settings(overrides=nested(key, value))
    lines = str(caught.value).splitlines()
    assert all(line.startswith((f"{CONFIGS}/", "--config: ")) and "accepted: " in line for line in lines)
    assert len(set(lines)) == len(lines)


def test_all_faults_of_all_files_are_told_at_once() -> None:
    bad = {"observer": {"gain_hz": 0.0}, "plant": {"contact_friction": -1.0, "springs": 2}, "seed": "x"}
    with pytest.raises(ConfigError) as caught:
        load_settings(overrides=bad)
    places = [line.split(": ")[1] for line in str(caught.value).splitlines()]
    assert sorted(places) == ["observer.gain_hz", "plant.contact_friction", "plant.springs", "seed"]


def test_the_rows_of_a_table_are_printed_and_have_windows(settings: Settings) -> None:
    row = settings.evaluation.tables["table_05"].rows[0].model_dump()
    for change, message in (
        ({"metric": "rmse_pushed"}, f"test with a window around pushes: 'forward_walk' {ACCEPTED}hand_load_10"),
        (
            {"paper": "rows.ideal"},
            f"rows.0.paper: place of a row: 'rows.ideal' {ACCEPTED}ideal, all_uncertainty, sensor_noise",
        ),
    ):
        with pytest.raises(ConfigError, match=message):
            load_settings(overrides=nested("evaluation.tables.table_05.rows", [{**row, **change}]))


@pytest.mark.parametrize(
    ("place", "message"),
    [
        *((place, rf"/{place.replace('.', '.yaml:1: ', 1)}: {EXPECTED}") for place in MISSING),
        # a push without a pause and without times would never end
        *((f"data.pushes.torso.{key}", r"data\.yaml:\d+: pushes\.torso: .*; accepted: `p") for key in OF_A_PUSH),
        *((f"data.training_sets.{name}.sizes.smoke", rf"\.{name}\.sizes: no scale smoke is not acc") for name in SETS),
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
    with pytest.raises(ConfigError, match=r"methods\.yaml:\d+: observer: stands in .*walking\.yaml too, which"):
        load_settings(folder)


def test_every_section_is_known_to_stand_in_its_file() -> None:
    found = {part: tuple(read_yaml(CONFIGS / f"{part}.yaml")) for part in PARTS}
    assert found == {part: tuple(sections) for part, sections in PARTS.items()}


CHAIN = "".join(f" - &a{k} [{f'*a{k - 1}' if k else 1}]\n" for k in range(5000))
DEEP = {
    "a few hundred levels": (f"x: {'[' * 400}{']' * 400}", "more than 100 levels at \\["),
    "more than the C library takes": (f"x: {'[' * 200_000}", "more than 100 levels at \\["),
    "aliases": (f"x: 1\nx:\n{CHAIN}y: *a4999\n", "aliases nested too deep are not accepted"),
}


@pytest.mark.parametrize("name", DEEP)
def test_deep_nesting_is_one_line(name: str, tmp_path: Path) -> None:
    text, says = DEEP[name]
    (tmp_path / "x.yaml").write_text(text)
    with pytest.raises(ConfigError, match=rf"x.yaml:1: top level: .*({says})"):
        read_yaml(tmp_path / "x.yaml")
