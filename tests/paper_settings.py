"""The whole configuration, for tests of the paper and of whole runs. A conftest imports the fixtures."""

from functools import cache

import pytest
from library_settings import recipes

from experiments.plan.plan import with_precision
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from experiments.settings.runs import Statistics
from experiments.settings.settings import Settings
from mobnet.learning.precision import of_processor

STATISTICS = Statistics(confidence=0.95, most_correlation=0.6, most_variation=1.0)


@cache
def settings_at(scale: str = "default") -> Settings:
    """Return the repository's configuration at a scale, which is read once: it takes a second."""
    return load_settings(overrides={"scale": scale})


@pytest.fixture(scope="session")
def settings():
    """The repository's configuration at its smoke scale, with this machine's number format."""
    return with_precision(settings_at("smoke"), of_processor())


@pytest.fixture(scope="session")
def recipe_of(settings):
    """The same as the library's, for the methods of sweeps too."""
    return recipes(settings, Catalogue(settings).all_methods)
