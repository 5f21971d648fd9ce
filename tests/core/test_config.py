"""A configuration is accepted whole, or refused in one line that names key, value and what is accepted."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import pytest
import yaml

from mobnet.core.config import FIRST_TRAINING_SEED, SCHEMA, check_config, config_hash, load_config, read_yaml
from mobnet.core.errors import ConfigError

CONFIG = Path("configs/config.yaml")
DRAWN = ("terrain", "commands", "narrowed", "motion")  # of a scenario


@pytest.fixture
def config() -> dict[str, Any]:
    return read_yaml(CONFIG)


def changed(config: dict[str, Any], key: str, value: object) -> dict[str, Any]:
    """Return a copy with the value at a dotted key replaced."""
    copied = copy.deepcopy(config)
    *parents, last = key.split(".")
    place = copied
    for parent in parents:
        place = place[parent]
    place[last] = value
    return copied


@pytest.mark.parametrize("scale", ["smoke", "default", "paper"])
def test_every_scale_is_accepted(scale: str) -> None:
    assert load_config(CONFIG, scale)["sizes"] == read_yaml(CONFIG)["scales"][scale]


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("observer.gain", 3.0, r"observer: .*'gain' was unexpected.*accepted keys: gain_hz"),
        ("colour", "red", r"top level: .*'colour' was unexpected.*accepted keys: claims"),
        ("scales.smoke.test.shard_s", -10.0, r"scales\.smoke\.test\.shard_s: -10\.0 .*exclusiveMinimum"),
        ("scales.default.experiments.sweep.epochs", 0, r"scales\.default\.experiments\.sweep\.epochs: 0 .*minimum"),
        ("scenarios.walk_test.commands", "sprint", r"walk_test\.commands: 'sprint' does not match '\^\(random"),
        ("scenarios.knee_swing.commands", {"duration_s": 0.7}, r"knee_swing\.commands: 'step_x_m' is a required"),
        ("scenarios.forward_walk.commands.duration_s", -0.7, r"\.commands\.duration_s: -0\.7 .*exclusiveMinimum"),
        ("rates.plant_hz", "fast", r"rates\.plant_hz: 'fast' is not of type 'number'"),
        ("levels.ideal.base_state", "guessed", r"'guessed' is not one of \['true_state', 'sensed'\]"),
        ("scale", "huge", r"scale: 'huge' is not accepted; accepted: default, paper, smoke"),
        ("methods.MOB-Net.limbs", ["LL", "tail"], r"methods\.MOB-Net\.limbs: 'tail' is not accepted; accepted: LA, LL"),
        ("networks.LL.Q", ["tail"], r"networks\.LL\.Q: 'tail' is not accepted; accepted: LA, LL, N, RA, RL, V, W"),
        ("scenarios.forward_walk.terrain", "checks", r"forward_walk\.terrain: 'checks' is not of type 'array'"),
        ("scenarios.forward_walk.terrain", [], r"forward_walk\.terrain: \[\] "),
        ("scenarios.walk_test.terrain", ["flat", "ice"], r"walk_test\.terrain: 'ice' is not accepted; accepted: check"),
        ("scenarios.knee_swing.pushes", ["elbow"], r"knee_swing\.pushes: 'elbow' is not accepted; accepted: hip_pitch"),
        ("scenarios.motion_test.motion", "dance", r"motion_test\.motion: 'dance' is not accepted; accepted: random_m"),
        ("scenarios.hand_load_10.draws", "hops", r"hand_load_10\.draws: 'hops' is not accepted; accepted: forward_w"),
        ("pushes.hip_pitch.joint", "LL9", r"pushes\.hip_pitch\.joint: 'LL9' is not accepted; accepted: "),
        ("tests.stroll", ["ideal"], r"tests: 'stroll' is not accepted; accepted: forward_walk"),
        ("tests.walk_test", ["perfect"], r"tests\.walk_test: 'perfect' is not accepted; accepted: all_uncertainty"),
        ("evaluation.figure_05.joint", "LL9", r"figure_05\.joint: 'LL9' is not accepted"),
        ("evaluation.figure_05.scenario", "dance", r"figure_05\.scenario: 'dance' is not accepted"),
        ("evaluation.error_budget.joints", ["LL9"], r"error_budget\.joints: 'LL9' is not accepted"),
        ("evaluation.windows.stroll", {"before_s": 0.0, "after_s": 0.1}, r"windows: 'stroll' is not accepted"),
        ("scales.smoke.train.walk.level", "none", r"smoke\.train\.walk\.level: 'none' is not accepted; accepted: all_"),
        ("scales.paper.train.motion.scenario", "nap", r"paper\.train\.motion\.scenario: 'nap' is not accepted"),
        ("networks.LL.data", "walks", r"networks\.LL\.data.*'walks' is not"),
    ],
)
def test_fault_is_one_line_with_key_value_and_accepted(
    config: dict[str, Any], key: str, value: object, message: str
) -> None:
    with pytest.raises(ConfigError, match=message) as caught:
        check_config(changed(config, key, value), "some.yaml")
    text = str(caught.value)
    assert text.startswith("some.yaml: ")
    assert "\n" not in text


@pytest.mark.parametrize("key", ["seed", "pushes", "tests", "motions", "scales"])
def test_missing_key_is_named(config: dict[str, Any], key: str) -> None:
    del config[key]
    with pytest.raises(ConfigError, match=rf"'{key}' is a required property; required keys: scale, seed"):
        check_config(config)


@pytest.mark.parametrize("key", ["pause_s", "force_n", "point", "direction"])
def test_push_says_where_when_and_how_hard(config: dict[str, Any], key: str) -> None:
    """A push without a pause and without times would never end."""
    del config["pushes"]["torso"][key]
    with pytest.raises(ConfigError, match=r"pushes\.torso: .* is not valid under any of the given schemas"):
        check_config(config)


@pytest.mark.parametrize("key", ["walk", "walk_plain", "motion"])
def test_every_scale_has_every_training_set(config: dict[str, Any], key: str) -> None:
    del config["scales"]["smoke"]["train"][key]
    with pytest.raises(ConfigError, match=rf"scales\.smoke\.train: '{key}' is a required property"):
        check_config(config)


def test_seeds_of_tests_and_training_never_meet(config: dict[str, Any]) -> None:
    for sizes in config["scales"].values():
        assert sizes["test"]["shards"] < FIRST_TRAINING_SEED


def test_scenarios_that_draw_the_same_differ_in_pushes_or_random_torque_alone(config: dict[str, Any]) -> None:
    scenarios = config["scenarios"]
    for name, row in scenarios.items():
        if "draws" not in row:
            continue
        drawn = scenarios[row["draws"]]
        assert [row.get(key) for key in DRAWN] == [drawn.get(key) for key in DRAWN], name


def test_file_that_is_missing_or_no_mapping_is_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"no\.yaml: file is missing"):
        read_yaml(tmp_path / "no.yaml")
    (tmp_path / "list.yaml").write_text("[1, 2]")
    with pytest.raises(ConfigError, match=r"list\.yaml: a mapping is expected, found list"):
        read_yaml(tmp_path / "list.yaml")
    (tmp_path / "bad.yaml").write_text("a: [1")
    with pytest.raises(ConfigError, match=r"bad\.yaml: not YAML"):
        read_yaml(tmp_path / "bad.yaml")


def test_hash_ignores_key_order_and_sees_values() -> None:
    assert config_hash({"a": 1, "b": 2}) == config_hash({"b": 2, "a": 1})
    assert config_hash({"a": 1}) != config_hash({"a": 2})


def objects(schema: object) -> list[dict[str, Any]]:
    """Return every schema of a mapping within a schema."""
    if isinstance(schema, list):
        return [found for item in schema for found in objects(item)]
    if not isinstance(schema, dict):
        return []
    own = [schema] if "properties" in schema and "type" in schema else []
    return own + [found for item in schema.values() for found in objects(item)]


def test_schema_is_closed_at_every_level() -> None:
    found = objects(yaml.safe_load(SCHEMA.read_text()))
    assert len(found) > 20
    assert all(schema["additionalProperties"] is False for schema in found)
