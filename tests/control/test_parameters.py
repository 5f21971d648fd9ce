"""Parameters are exactly the `walking` section; the state starts at zero."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mobnet.control.parameters import STATE, WalkingParameters, empty_state, walking_parameters
from mobnet.core.errors import ConfigError


def test_parameters_are_the_section_in_order_of_the_tuple(full_config: dict[str, Any], par: WalkingParameters) -> None:
    for name, value in full_config["walking"].items():
        np.testing.assert_array_equal(getattr(par, name), value)
    assert set(full_config["walking"]) == set(par._fields)


@pytest.mark.parametrize("key", ["dcm_gian", "dcm_gain"])
def test_unknown_and_missing_keys_are_named(full_config: dict[str, Any], key: str) -> None:
    settings = dict(full_config["walking"])
    if settings.pop(key, None) is None:
        settings[key] = 1.0
    with pytest.raises(ConfigError, match=f"walking: key: '{key}' is not accepted"):
        walking_parameters(settings)


def test_state_starts_at_zero_and_states_do_not_share_memory() -> None:
    first, second = empty_state(), empty_state()
    first.t = 1.0
    assert all(not np.any(second[name]) for name in STATE.names or ())
