"""What the sections of the reaction and of obstacles say of each other fits."""

import pytest

from experiments.settings.load import load_settings
from mobnet.core.errors import ConfigError


@pytest.mark.parametrize(("changes", "text"), [
    ({"scenarios": {"foot_block": {"obstacles": ["wall"]}}}, "obstacle: 'wall' is not"),
    ({"reaction": {"cases": {"foot": {"scenario": "forward_walk"}}}}, "'foot' is not accepted; accepted: .*knee"),
    ({"evaluation": {"sensorless": {"cases": ["foot"]}}}, "'foot' is not accepted; accepted: .*free"),
    ({"reaction": {"ours": {"detector": "MOB-command"}}}, "detector that reacts: 'MOB-command' is not"),
    ({"reaction": {"estimator": "FTS-e2e"}}, "networks of V"),
    ({"scenarios": {"forward_walk": {"wrench": "estimated"}}}, "`sensed` where reaction.cases does not walk it"),
])  # fmt: skip
def test_what_does_not_fit_is_refused(changes, text):
    with pytest.raises(ConfigError, match=text):
        load_settings(overrides=changes)
