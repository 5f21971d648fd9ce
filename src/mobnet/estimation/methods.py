"""From a row of the configuration's methods to an estimator; its `kind` names a module of this package.

A module is a kind if it has a function `build(recipe) -> Estimator`. A kind that must be fitted to the training sets
without networks has `fit(config, method, training)` too, and its rows name the limbs that are `fitted`.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.estimator import Estimator
from mobnet.core.methods import method_row
from mobnet.estimation.recipe import Recipe

PACKAGE = importlib.import_module("mobnet.estimation")


def build_estimator(
    config: Mapping[str, Any],
    method: str,
    network_dirs: Mapping[str, Path],
    level: str,
    rate_hz: float,
    fitted: Path | None = None,
) -> Estimator:
    """Build the estimator of a method, one row of Table 5.

    Args:
        config: resolved configuration.
        method: row of its methods.
        network_dirs: limb -> folder of its trained network, for each of the method's limbs; empty for MOB.
        level: uncertainty level of section 5.1, which says how wrong the observer's nominal model is.
        rate_hz: samples per second [Hz].
        fitted: what rule `fit` wrote, for a method whose row names `fitted` limbs.

    Raises:
        ConfigError: the method, its kind or the level is unknown, or files do not match its row.
        DataError: a file is missing or damaged.
    """
    recipe = Recipe(config, method, level, rate_hz, network_dirs, fitted)
    return kind_of(recipe.row, method).build(recipe)


def kind_of(row: Mapping[str, Any], method: str) -> ModuleType:
    """Return the module that a method's row names as its kind.

    Raises:
        ConfigError: no module of this package has the name and a function `build`.
    """
    if row["kind"] in _modules():
        module = _module(row["kind"])
        if hasattr(module, "build"):
            return module
    accepted = [name for name in _modules() if hasattr(_module(name), "build")]
    raise ConfigError(not_accepted(f"kind of method {method}", row["kind"], accepted))


def fitted_kind(config: Mapping[str, Any], method: str) -> ModuleType:
    """Return the kind of a method that is fitted without networks.

    Raises:
        ConfigError: the method or its kind is unknown, or it is not one that is fitted.
    """
    row = method_row(config, method)
    module = kind_of(row, method)
    if "fitted" not in row or not hasattr(module, "fit"):
        accepted = [name for name, other in config["methods"].items() if "fitted" in other and name != method]
        raise ConfigError(not_accepted("method to fit", method, accepted))
    return module


def _modules() -> list[str]:
    """Return the names of this package's modules."""
    return [module.name for module in pkgutil.iter_modules(PACKAGE.__path__)]


def _module(name: str) -> ModuleType:
    """Return a module of this package."""
    return importlib.import_module(f"{PACKAGE.__name__}.{name}")
