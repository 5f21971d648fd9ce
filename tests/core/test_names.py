"""A name in the configuration is one that exists."""

from __future__ import annotations

from typing import Any

import pytest

from mobnet.core.errors import ConfigError
from mobnet.core.joints import JointLayout
from mobnet.core.names import (
    ablation_uses,
    calibration_uses,
    check_names,
    evaluation_uses,
    method_uses,
    network_uses,
    scenario_uses,
    size_uses,
)


def test_the_repository_names_only_what_exists(full_config: dict[str, Any], layout: JointLayout) -> None:
    check_names(full_config, layout)


def test_every_reference_is_looked_at(full_config: dict[str, Any], layout: JointLayout) -> None:
    every = (network_uses, method_uses, scenario_uses, size_uses, evaluation_uses, ablation_uses, calibration_uses)
    keys = {key for uses in every for key, _, _ in uses(full_config, layout)}
    expected = {
        "networks.V.Q",
        "networks.WB.joints",
        "networks.LL.experiment",
        "sweeps.hidden.of",
        "methods.MOB-Net.limbs",
        "methods.MOB-fric.fitted",
        "methods.MOB-fric-BPF.of",
        "scale",
        "scenarios.random_walk.terrain",
    }
    expected |= {"evaluation.table_05.levels.ideal", "evaluation.figure_05.joint", "tests", "tests.walk_test"}
    expected |= {"scenarios.random_walk.pushes", "scenarios.random_motion.motion", "scenarios.hand_load_10.draws"}
    expected |= {"pushes.hip_pitch.joint", "scales.paper.train.walk.scenario", "scales.smoke.train.motion.level"}
    expected |= {"evaluation.table_01.method", "evaluation.figure_17.methods", "evaluation.kinds.variants"}
    expected |= {"evaluation.figure_18.scenario", "evaluation.figure_18.limbs", "evaluation.figure_20.samples"}
    expected |= {"evaluation.methods.scenario", "evaluation.methods.level", "evaluation.methods.methods"}
    expected |= {f"evaluation.calibration.tests.{key}" for key in ("scenario", "level", "pushed", "methods", "limbs")}
    expected |= {"evaluation.calibration.methods", "evaluation.calibration.share"}
    assert expected <= keys


def test_a_sweep_that_a_figure_shows_must_exist(full_config: dict[str, Any], layout: JointLayout) -> None:
    evaluation = full_config["evaluation"]
    changed = {**evaluation, "figure_20": {**evaluation["figure_20"], "samples": "shares"}}
    with pytest.raises(
        ConfigError, match=r"figure_20\.samples: 'shares' is not accepted; accepted: data_parts, hidden"
    ):
        check_names({**full_config, "evaluation": changed}, layout)


def test_unknown_method_of_a_table_is_named(full_config: dict[str, Any], layout: JointLayout) -> None:
    table = {**full_config["evaluation"]["table_05"], "levels": {"ideal": ["MOB", "magic"]}}
    config = {**full_config, "evaluation": {**full_config["evaluation"], "table_05": table}}
    with pytest.raises(ConfigError, match=r"table_05\.levels\.ideal: 'magic' is not accepted; accepted: FTS-e2e, "):
        check_names(config, layout)


@pytest.mark.parametrize(("key", "value"), [("fitted", ["tail"]), ("of", "magic"), ("of", "MOB-fric-BPF")])
def test_a_method_names_limbs_and_a_method_that_runs_on_its_own(
    key: str, value: Any, full_config: dict[str, Any], layout: JointLayout
) -> None:
    config = {**full_config, "methods": {**full_config["methods"], "M": {"kind": "band_pass", key: value}}}
    with pytest.raises(ConfigError, match=rf"methods\.M\.{key}: .* is not accepted; accepted: "):
        check_names(config, layout)
