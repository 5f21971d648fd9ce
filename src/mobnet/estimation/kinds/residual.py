"""The residual alone, or without what limb networks predict: MOB and MOB-Net, eq. (15)."""

from collections.abc import Iterator

from mobnet.core.errors import misfit
from mobnet.estimation.recipe import Recipe
from mobnet.estimation.residual import ResidualEstimator
from mobnet.formats.base import Section
from mobnet.formats.reading import Place
from mobnet.settings.methods import Method


def check(method: Method, options: Section, rate_hz: float) -> Iterator[tuple[Place, str]]:
    """Yield what is not accepted in the row of a method: it has networks, if any, that learn the uncertainty."""
    if method.target not in (None, "uncertainty") or method.fitted or method.of:
        yield ("target",), misfit(method.target, "uncertainty, and neither `fitted` nor `of`")


def build(recipe: Recipe) -> ResidualEstimator:
    """Build MOB, or MOB-Net of the method's limbs."""
    return ResidualEstimator(recipe.observer(), recipe.layout, recipe.limb_networks())
