"""A recipe holds the files that its row needs, no more and no fewer."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mobnet.core.errors import ConfigError
from mobnet.estimation.recipe import Recipe

LEVEL, RATE_HZ = "all_uncertainty", 1000.0


def test_a_fit_must_be_there_where_the_row_is_fitted(full_config: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="'MOB-fric' with the fit None; accepted: the file that rule `fit` writes"):
        Recipe(full_config, "MOB-fric", LEVEL, RATE_HZ)
    with pytest.raises(ConfigError, match=r"'MOB' with the fit .*; accepted: none"):
        Recipe(full_config, "MOB", LEVEL, RATE_HZ, fitted=tmp_path)


def test_a_method_of_another_needs_the_others_files(full_config: dict[str, Any], tmp_path: Path) -> None:
    recipe = Recipe(full_config, "MOB-fric-BPF", LEVEL, RATE_HZ, fitted=tmp_path)
    assert recipe.row["of"] == "MOB-fric"
    with pytest.raises(ConfigError, match="'MOB-fric-BPF' with the fit None"):
        Recipe(full_config, "MOB-fric-BPF", LEVEL, RATE_HZ)


def test_without_limbs_there_are_no_networks(full_config: dict[str, Any]) -> None:
    recipe = Recipe(full_config, "MOB", LEVEL, RATE_HZ)
    assert recipe.limb_networks() is None
    assert recipe.observer().nominal.mass_ratio == full_config["levels"][LEVEL]["nominal_mass_ratio"]
