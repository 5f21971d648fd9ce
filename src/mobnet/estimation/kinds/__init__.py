"""Kinds of estimators: each is a module, which methods of the configuration name as their `kind`.

Such a module has a function `build(recipe) -> Estimator` and, where a kind has numbers of its own, a section `Options`.
What it asks of a method's row is said by `check(method, options, rate_hz)`, which yields places and texts. A kind that
is fitted without networks also has `fit(layout, observer, options, networks, training)`; it returns JSON.
"""

import importlib
import pkgutil
from types import ModuleType

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.estimator import TorqueEstimator
from mobnet.estimation.recipe import Recipe


def build_estimator(recipe: Recipe) -> TorqueEstimator:
    """Build the estimator of a method, one row of Table 5.

    Raises:
        ConfigError: the method's kind is unknown, or its numbers are not those of its kind.
        DataError: a file is missing or damaged.
    """
    return kind_of(recipe.name, recipe.method.kind).build(recipe)


def kind_of(name: str, kind: str) -> ModuleType:
    """Return the module of the kind that a method of some name has.

    Raises:
        ConfigError: there is no such kind.
    """
    if kind not in kind_names():
        raise ConfigError(not_accepted(f"methods.{name}.kind", kind, kind_names()))
    return importlib.import_module(f"{__name__}.{kind}")


def kind_names() -> list[str]:
    """Return the names of all kinds."""
    return [module.name for module in pkgutil.iter_modules(__path__)]
