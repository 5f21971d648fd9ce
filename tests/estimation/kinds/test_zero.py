"""The zero predictor."""

from collections.abc import Callable

from mobnet.core.recording import Recording
from mobnet.estimation.kinds.zero import check
from mobnet.estimation.methods import build_estimator
from mobnet.estimation.recipe import Recipe
from mobnet.settings.base import Section
from mobnet.settings.methods import Method
from mobnet.settings.settings import Settings


def test_it_is_zero_for_every_joint_of_the_robot(
    settings: Settings, recipe_of: Callable[..., Recipe], made_up: Callable[..., Recording]
) -> None:
    estimator = build_estimator(recipe_of("zero"))
    result = estimator.estimate(made_up(0, 0.1).sensed)
    assert estimator.joints == settings.layout.names
    assert result.tau_ext.shape == (100, settings.layout.nv)
    assert not result.tau_ext.any()
    assert result.std is None


def test_it_has_nothing_to_learn() -> None:
    ((place, text),) = check(Method(kind="zero", fitted=("LL",)), Section(), 1000.0)
    assert place == ()
    assert text == "`limbs`, `fitted` or `of` is not accepted; accepted: `kind` alone"
