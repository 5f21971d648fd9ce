"""From a row of the configuration's methods to an estimator."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.estimator import Estimator
from mobnet.estimation.direct import DirectEstimator
from mobnet.estimation.observe import observer_of
from mobnet.estimation.residual import ResidualEstimator
from mobnet.learning.limbs import load_limb_networks
from mobnet.robot.description import load_robot

KINDS = ("residual", "direct")


def build_estimator(
    config: Mapping[str, Any], method: str, network_dirs: Mapping[str, Path], level: str, rate_hz: float
) -> Estimator:
    """Build the estimator of a method, one row of Table 5.

    Args:
        config: resolved configuration.
        method: row of its methods.
        network_dirs: limb -> folder of its trained network, for each of the method's limbs; empty for MOB.
        level: uncertainty level of section 5.1, which says how wrong the observer's nominal model is.
        rate_hz: samples per second [Hz].

    Raises:
        ConfigError: the method, its kind or the level is unknown, or networks do not match its limbs.
        DataError: weights are missing or damaged.
    """
    row = method_row(config, method)
    limbs = row.get("limbs", [])
    if set(limbs) != set(network_dirs):
        raise ConfigError(not_accepted(f"networks of method {method}", sorted(network_dirs), [sorted(limbs)]))
    robot = load_robot(Path(config["robot"]))
    networks = load_limb_networks({limb: network_dirs[limb] for limb in limbs}, robot.layout) if limbs else None
    if row["kind"] == "residual":
        return ResidualEstimator(observer_of(config, robot, level, rate_hz), networks)
    if networks is None:
        raise ConfigError(f"method {method!r} of kind 'direct' names no limbs; accepted: one or more of its networks")
    return DirectEstimator(networks)


def method_row(config: Mapping[str, Any], method: str) -> Mapping[str, Any]:
    """Return a method's row of the configuration, such as the rows of Table 5.

    Raises:
        ConfigError: the method or its kind is unknown.
    """
    if method not in config["methods"]:
        raise ConfigError(not_accepted("method", method, config["methods"]))
    row = config["methods"][method]
    if row["kind"] not in KINDS:
        raise ConfigError(not_accepted(f"kind of method {method}", row["kind"], KINDS))
    return row
