"""A name in the configuration is one that exists."""

from __future__ import annotations

from typing import Any

import pytest

from mobnet.core.errors import ConfigError
from mobnet.core.joints import JointLayout
from mobnet.core.names import (
    USES,
    check_names,
)


def test_the_repository_names_only_what_exists(full_config: dict[str, Any], layout: JointLayout) -> None:
    check_names(full_config, layout)


def test_every_reference_is_looked_at(full_config: dict[str, Any], layout: JointLayout) -> None:
    keys = {key for uses in USES for key, _, _ in uses(full_config, layout)}
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
    expected |= {"evaluation.figure_05.panels.sensor_noise", "evaluation.figure_05.joint", "tests", "tests.walk_test"}
    expected |= {f"evaluation.tables.table_05.{key}" for key in ("joints", "scenario", "level", "methods")}
    expected |= {"evaluation.error_budget.joints", "evaluation.error_budget.methods", "evaluation.windows"}
    expected |= {"scenarios.random_walk.pushes", "scenarios.random_motion.motion", "scenarios.hand_load_10.draws"}
    expected |= {"pushes.hip_pitch.joint", "scales.paper.train.walk.scenario", "scales.smoke.train.motion.level"}
    expected |= {"evaluation.table_01.method", "evaluation.figure_17.methods", "evaluation.kinds.variants"}
    expected |= {"evaluation.figure_18.scenario", "evaluation.figure_18.limbs", "evaluation.figure_20.samples"}
    expected |= {"evaluation.methods.scenario", "evaluation.methods.level", "evaluation.methods.methods"}
    expected |= {f"evaluation.calibration.tests.{key}" for key in ("scenario", "level", "pushed", "methods", "limbs")}
    expected |= {"evaluation.calibration.methods", "evaluation.calibration.share"}
    expected |= {f"evaluation.figure_06.{key}" for key in ("joint", "scenario", "level", "methods")}
    expected |= {"evaluation.figure_07.joints", "evaluation.figure_08.limb", "evaluation.figure_09.limb"}
    expected |= {"evaluation.figure_10.tests.swing knee.joint", "evaluation.figure_10.against.methods"}
    assert expected <= keys


def test_a_sweep_that_a_figure_shows_must_exist(full_config: dict[str, Any], layout: JointLayout) -> None:
    evaluation = full_config["evaluation"]
    changed = {**evaluation, "figure_20": {**evaluation["figure_20"], "samples": "shares"}}
    with pytest.raises(
        ConfigError, match=r"figure_20\.samples: 'shares' is not accepted; accepted: data_parts, hidden"
    ):
        check_names({**full_config, "evaluation": changed}, layout)


def test_unknown_method_of_a_table_is_named(full_config: dict[str, Any], layout: JointLayout) -> None:
    with pytest.raises(ConfigError, match=r"table_05\.methods: 'magic' is not accepted; accepted: FTS-e2e, "):
        check_names(with_row(full_config, methods=["MOB", "magic"]), layout)


def test_a_table_asks_for_pushes_only_where_they_are_scored(full_config: dict[str, Any], layout: JointLayout) -> None:
    check_names(with_row(full_config, scenario="knee_swing", metric="rmse_pushed"), layout)
    with pytest.raises(
        ConfigError, match=r"table_05\.scenario, around pushes: 'walk_test' is not accepted; accepted: "
    ):
        check_names(with_row(full_config, scenario="walk_test", metric="rmse_pushed"), layout)


def test_a_figure_of_pushes_shows_scenarios_that_are_scored_around_them(
    full_config: dict[str, Any], layout: JointLayout
) -> None:
    evaluation = full_config["evaluation"]
    changed = {**evaluation, "figure_06": {**evaluation["figure_06"], "scenario": "walk_test"}}
    with pytest.raises(ConfigError, match=r"figure_06\.scenario, around pushes: 'walk_test' is not accepted"):
        check_names({**full_config, "evaluation": changed}, layout)


def with_row(config: dict[str, Any], **changes: Any) -> dict[str, Any]:
    """Return a configuration whose Table 5 begins with a row that is changed."""
    tables = config["evaluation"]["tables"]
    first, *others = tables["table_05"]["rows"]
    table = {**tables["table_05"], "rows": [{**first, **changes}, *others]}
    return {**config, "evaluation": {**config["evaluation"], "tables": {**tables, "table_05": table}}}


@pytest.mark.parametrize(("key", "value"), [("fitted", ["tail"]), ("of", "magic"), ("of", "MOB-fric-BPF")])
def test_a_method_names_limbs_and_a_method_that_runs_on_its_own(
    key: str, value: Any, full_config: dict[str, Any], layout: JointLayout
) -> None:
    config = {**full_config, "methods": {**full_config["methods"], "M": {"kind": "band_pass", key: value}}}
    with pytest.raises(ConfigError, match=rf"methods\.M\.{key}: .* is not accepted; accepted: "):
        check_names(config, layout)
