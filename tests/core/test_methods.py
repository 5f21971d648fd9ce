"""Methods, the networks they change, and the sweeps that stand for more of them."""

from __future__ import annotations

from typing import Any

import pytest

from mobnet.core.errors import ConfigError
from mobnet.core.methods import experiment_row, learning_row, method_row, network_row, source_of, with_sweeps

BASE = {"A": {"kind": "residual", "limbs": ["LL", "RL"], "network": {"cell": "GRU"}}}
SWEEP = {"of": ["A"], "limb": "LL", "experiment": "sweep", "section": "network", "values": [1, 2]}


def test_a_sweep_stands_for_one_method_a_value() -> None:
    methods = with_sweeps(BASE, {"hidden": SWEEP})
    assert list(methods) == ["A", "A-hidden-1", "A-hidden-2"]
    assert methods["A"] == BASE["A"]
    assert methods["A-hidden-2"]["network"] == {"cell": "GRU", "experiment": "sweep", "hidden": 2}
    assert methods["A-hidden-2"]["limbs"] == ["LL"]


def test_a_sweep_of_learning_leaves_the_network() -> None:
    row = with_sweeps(BASE, {"data_parts": SWEEP | {"section": "learning"}})["A-data-parts-2"]
    assert row["learning"] == {"data_parts": 2}
    assert row["network"] == {"cell": "GRU", "experiment": "sweep"}


def test_a_method_changes_its_networks_alone(full_config: dict[str, Any]) -> None:
    plain, base = (network_row(full_config, method, "LL") for method in ("MOB-Net-plain", "MOB-Net"))
    assert plain == {**base, "data": "walk_plain"}
    assert base["joints"] == ["LL"]
    assert network_row(full_config, "MOB-Net-Single", "WB")["joints"] == full_config["networks"]["WB"]["joints"]


def test_a_networks_experiment_says_how_long_it_trains(full_config: dict[str, Any]) -> None:
    sizes = full_config["sizes"]["experiments"]
    assert experiment_row(full_config, "MOB-Net", "LL") == sizes["left_leg"]
    assert experiment_row(full_config, "MOB-Net-hidden-44", "LL") == sizes["sweep"]


def test_sizes_lie_over_settings_and_the_methods_changes_over_both(full_config: dict[str, Any]) -> None:
    methods = {"A": {"learning": {"rate_first": 0.05}}}
    config = full_config | {"methods": methods, "sizes": {"batch_size": 3}}
    learned = learning_row(config, "A")
    assert (learned["batch_size"], learned["rate_first"]) == (3, 0.05)
    assert learned["stream_s"] == full_config["learning"]["stream_s"]


def test_unknown_names_are_refused(full_config: dict[str, Any]) -> None:
    with pytest.raises(ConfigError, match="'X' is not accepted; accepted: "):
        method_row(full_config, "X")
    with pytest.raises(ConfigError, match="'tail' is not accepted"):
        network_row(full_config, "MOB-Net", "tail")


def test_a_method_runs_on_the_files_of_the_one_it_names() -> None:
    config = {"methods": {"A": {"kind": "residual"}, "B": {"kind": "band_pass", "of": "A"}}}
    assert [source_of(config, method) for method in ("A", "B")] == ["A", "A"]
