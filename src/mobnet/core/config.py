"""Reading the configuration: one YAML, one schema, one scale chosen."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from jsonschema import ValidationError, validate

from mobnet.core.errors import ConfigError
from mobnet.core.joints import JointLayout, layout_of
from mobnet.core.methods import with_sweeps
from mobnet.core.names import check_names

SCHEMA = Path(__file__).parents[3] / "workflow" / "schemas" / "config.schema.yaml"
FIRST_TRAINING_SEED = 1000  # recordings and motions for tests count from 1
BOUNDS = ("type", "pattern", "minimum", "exclusiveMinimum", "maximum", "minItems", "maxItems")


def read_yaml(path: Path) -> dict[str, Any]:
    """Read a YAML mapping.

    Raises:
        ConfigError: the file is missing or is not a mapping.
    """
    try:
        value = yaml.safe_load(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ConfigError(f"{path}: file is missing") from None
    except yaml.YAMLError as error:
        raise ConfigError(f"{path}: not YAML, {' '.join(str(error).split())}") from None
    if not isinstance(value, dict):
        raise ConfigError(f"{path}: a mapping is expected, found {type(value).__name__}")
    return value


def load_config(path: Path, scale: str | None = None) -> dict[str, Any]:
    """Read and check the configuration and lay the chosen scale's sizes over it.

    Raises:
        ConfigError: the file, a key or a value is not accepted; the message names it.
    """
    config = read_yaml(path)
    if scale is not None:
        config["scale"] = scale
    check_config(config, str(path))
    return resolve(config)


def check_config(config: Mapping[str, Any], name: str = "config") -> None:
    """Check a configuration against the schema, and that the names it uses exist.

    Raises:
        ConfigError: one line with the key, the value and what is accepted.
    """
    try:
        validate(config, read_yaml(SCHEMA))
    except ValidationError as error:
        where = ".".join(map(str, error.absolute_path)) or "top level"
        raise ConfigError(f"{name}: {where}: {error.message}{_accepted(error)}") from None
    check_names(config, load_layout(Path(config["robot"])), name)


def _accepted(error: ValidationError) -> str:
    """Return what the schema would accept in place of the offending key or value."""
    schema: Mapping[str, Any] = error.schema if isinstance(error.schema, Mapping) else {}
    if error.validator == "additionalProperties":
        return f"; accepted keys: {', '.join(sorted(schema.get('properties', {})))}"
    if error.validator == "required":
        return f"; required keys: {', '.join(schema['required'])}"
    bounds = {key: schema[key] for key in BOUNDS if key in schema}
    return f"; accepted: {json.dumps(bounds)}" if bounds and error.validator != "enum" else ""


def resolve(config: Mapping[str, Any]) -> dict[str, Any]:
    """Return the configuration with `sizes` set to the chosen scale's entry and `sweeps` turned into methods."""
    methods = with_sweeps(config["methods"], config["sweeps"])
    return {**config, "sizes": config["scales"][config["scale"]], "methods": methods}


def load_layout(robot: Path) -> JointLayout:
    """Read the joint layout of a robot's table of figures."""
    table = read_yaml(robot)
    legs = {side: table["feet"][side]["limb"] for side in ("left", "right")}
    return layout_of(table["order"], table["groups"], legs)
