"""A configuration is accepted whole, or refused in one line that names key, value and what is accepted."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import pytest
import yaml

from mobnet.core.config import SCHEMA, check_config, config_hash, load_config, read_yaml
from mobnet.core.errors import ConfigError

CONFIG = Path("configs/config.yaml")


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
        ("scales.smoke.epochs", 0, r"scales\.smoke\.epochs: 0 .*minimum"),
        ("scenarios.forward_walk.commands.duration_s", -0.7, r"forward_walk\.commands.*-0\.7"),
        ("rates.plant_hz", "fast", r"rates\.plant_hz: 'fast' is not of type 'number'"),
        ("levels.ideal.base_state", "guessed", r"'guessed' is not one of \['true_state', 'sensed'\]"),
        ("scale", "huge", r"scale: 'huge' is not accepted; accepted: default, paper, smoke"),
        ("methods.MOB-Net.limbs", ["LL", "tail"], r"methods\.MOB-Net\.limbs: 'tail' is not accepted; accepted: LA, LL"),
        ("networks.LL.Q", ["tail"], r"networks\.LL\.Q: 'tail' is not accepted; accepted: LA, LL, N, RA, RL, V, W"),
        ("scenarios.forward_walk.terrain", "ice", r"forward_walk\.terrain: 'ice' is not accepted; accepted: checks"),
        ("evaluation.figure_05.joint", "LL9", r"figure_05\.joint: 'LL9' is not accepted"),
        ("evaluation.table_05.scenario", "dance", r"table_05\.scenario: 'dance' is not accepted"),
        ("scales.smoke.train.level", "none", r"scales\.smoke\.train\.level: 'none' is not accepted"),
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


def test_missing_key_is_named(config: dict[str, Any]) -> None:
    del config["seed"]
    with pytest.raises(ConfigError, match=r"'seed' is a required property; required keys: scale, seed"):
        check_config(config)


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
