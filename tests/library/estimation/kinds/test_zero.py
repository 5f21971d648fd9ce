"""The zero predictor."""

from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.kinds.zero import check
from mobnet.formats.base import Section
from mobnet.settings.methods import Method


def test_it_is_zero_for_every_joint_of_the_robot(settings, recipe_of, made_up):
    estimator = build_estimator(recipe_of("zero"))
    result = estimator.estimate(made_up(0, 0.1).sensed)
    assert estimator.joints == settings.layout.names
    assert result.tau_ext.shape == (100, settings.layout.nv)
    assert not result.tau_ext.any()
    assert result.std is None


def test_it_has_nothing_to_learn():
    ((place, text),) = check(Method(kind="zero", fitted=("LL",)), Section(), 1000.0)
    assert place == ()
    assert text == "`limbs`, `fitted` or `of` is not accepted; accepted: `kind` alone"
