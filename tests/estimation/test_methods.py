"""From a row of the configuration to an estimator, and rows that make none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mobnet.core.errors import ConfigError, DataError
from mobnet.estimation.methods import build_estimator
from mobnet.estimation.residual import ResidualEstimator

LEVEL, RATE_HZ = "ideal", 1000.0


def test_mob_estimates_every_joint(full_config: dict[str, Any]) -> None:
    estimator = build_estimator(full_config, "MOB", {}, LEVEL, RATE_HZ)
    assert isinstance(estimator, ResidualEstimator)
    assert len(estimator.joints) == 39


@pytest.mark.parametrize(
    ("method", "limbs", "level", "message"),
    [
        ("MOB2", [], LEVEL, "method: 'MOB2' is not accepted; accepted: FTS-e2e, "),
        ("MOB", [], "perfect", "level: 'perfect' is not accepted"),
        ("MOB", ["LL"], LEVEL, r"networks of method MOB: \['LL'\] is not accepted; accepted: \[\]"),
        ("FTS-e2e", ["LL"], LEVEL, r"networks of method FTS-e2e: \['LL'\] is not accepted; accepted: \['LL', 'RL'\]"),
    ],
)
def test_what_does_not_fit_is_named(
    method: str, limbs: list[str], level: str, message: str, full_config: dict[str, Any], tmp_path: Path
) -> None:
    with pytest.raises(ConfigError, match=message):
        build_estimator(full_config, method, dict.fromkeys(limbs, tmp_path), level, RATE_HZ)


def test_rows_that_make_no_estimator_are_refused(full_config: dict[str, Any]) -> None:
    rows = {"a": {"kind": "magic"}, "b": {"kind": "direct"}}
    config = full_config | {"methods": rows}
    with pytest.raises(ConfigError, match="'magic' is not accepted; accepted: band_pass, direct, friction, residual"):
        build_estimator(config, "a", {}, LEVEL, RATE_HZ)
    with pytest.raises(ConfigError, match="'b' of kind 'direct' names no limbs"):
        build_estimator(config, "b", {}, LEVEL, RATE_HZ)


def test_missing_weights_are_named(full_config: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"weights\.safetensors: file is missing"):
        build_estimator(full_config, "FTS-e2e", {"LL": tmp_path, "RL": tmp_path}, LEVEL, RATE_HZ)
