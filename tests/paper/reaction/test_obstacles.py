"""What the sections of the reaction and of obstacles say of each other fits."""

import pytest

from experiments.settings.load import load_settings
from mobnet.core.errors import ConfigError

SLOPING_CAPSULE = {"type": "capsule", "size": [0.1, 0.3], "pos": [0.0, 0.0, 1.0], "bevel_m": 0.01}


@pytest.mark.parametrize(("changes", "text"), [
    ({"scenarios": {"foot_block": {"obstacles": ["wall"]}}}, "obstacle: 'wall' is not"),
    ({"obstacles": {"cart": {"parts": [SLOPING_CAPSULE]}}}, "of a box"),
    ({"reaction": {"cases": {"foot": {"scenario": "forward_walk"}}}}, "'foot' is not accepted; accepted: .*knee"),
    ({"reaction": {"cases": {"free": {"limbs": ["LL", "LA"]}}}}, "and all legs: LL, RL"),
    ({"reaction": {"cases": {"foot": {"limbs": ["LL", "RL"]}}}}, "all limbs, where something is in the way"),
    ({"evaluation": {"sensorless": {"cases": ["foot"]}}}, "'foot' is not accepted; accepted: .*free"),
    ({"reaction": {"ours": {"detector": "MOB-command"}}}, "detector that reacts: 'MOB-command' is not"),
    ({"reaction": {"estimator": "FTS-e2e"}}, "networks of V"),
    ({"scenarios": {"forward_walk": {"wrench": "estimated"}}}, "`sensed` where reaction.cases does not walk it"),
])  # fmt: skip
def test_what_does_not_fit_is_refused(changes, text):
    with pytest.raises(ConfigError, match=text):
        load_settings(overrides=changes)
