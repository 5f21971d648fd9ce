"""Rows of the configuration's methods: estimators and ablations, with what they change of networks and learning.

A method's `network` is laid over each of its limbs' rows of `networks`, its `learning` over section `learning`; a row
of `sweeps` stands for one more method per value of its key.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mobnet.core.errors import ConfigError, not_accepted

Row = Mapping[str, Any]
SCALE_SIZES = ("batch_size", "stream_s", "rate_decay_share")  # learning settings that a scale may replace


def with_sweeps(methods: Mapping[str, Row], sweeps: Mapping[str, Row]) -> dict[str, Row]:
    """Return the methods and those that sweeps stand for, such as `MOB-Net-hidden-44` (section 6.3)."""
    swept = {
        swept_name(base, key, value): _laid_over(methods[base], sweep, {key: value})
        for key, sweep in sweeps.items()
        for base in sweep["of"]
        for value in sweep["values"]
    }
    return {**methods, **swept}


def swept_name(base: str, key: str, value: int) -> str:
    """Return the name of the method that stands for one value of a sweep."""
    return f"{base}-{key.replace('_', '-')}-{value}"


def _laid_over(base: Row, sweep: Row, change: Row) -> Row:
    """Return a method's row with a sweep's limb, experiment and changed key."""
    network = {**base.get("network", {}), "experiment": sweep["experiment"]}
    learning = dict(base.get("learning", {}))
    (network if sweep["section"] == "network" else learning).update(change)
    return {**base, "limbs": [sweep["limb"]], "network": network, "learning": learning}


def method_row(config: Row, method: str) -> Row:
    """Return a method's row, such as a row of Table 5.

    Raises:
        ConfigError: the method is unknown.
    """
    if method not in config["methods"]:
        raise ConfigError(not_accepted("method", method, config["methods"]))
    return config["methods"][method]


def source_of(config: Row, method: str) -> str:
    """Return the method whose networks or fit a method runs on: the one that `of` names, or itself.

    Raises:
        ConfigError: the method is unknown.
    """
    return method_row(config, method).get("of", method)


def network_row(config: Row, method: str, limb: str) -> Row:
    """Return the row of Table 1 of a method's limb; `joints` names its groups of joints.

    Raises:
        ConfigError: the method or the limb is unknown.
    """
    if limb not in config["networks"]:
        raise ConfigError(not_accepted("limb to train", limb, config["networks"]))
    return {"joints": [limb], **config["networks"][limb], **method_row(config, method).get("network", {})}


def experiment_row(config: Row, method: str, limb: str) -> Row:
    """Return how long and how often a network is trained at the chosen scale: `epochs`, `epoch_samples`, `seeds`.

    Raises:
        ConfigError: the method or the limb is unknown.
    """
    return config["sizes"]["experiments"][network_row(config, method, limb)["experiment"]]


def learning_row(config: Row, method: str) -> dict[str, Any]:
    """Return section `learning`, the scale's sizes laid over it, and over those what the method changes.

    Raises:
        ConfigError: the method is unknown.
    """
    sizes = {key: config["sizes"][key] for key in SCALE_SIZES if key in config["sizes"]}
    return {**config["learning"], **sizes, **method_row(config, method).get("learning", {})}
