"""The whole configuration, for tests of the paper and of whole runs. A conftest imports the fixtures."""

import pytest
from library_settings import recipes

from experiments.plan.plan import with_precision
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from mobnet.learning.precision import of_processor


@pytest.fixture(scope="session")
def settings():
    """The repository's configuration at its smoke scale, with this machine's number format."""
    return with_precision(load_settings(overrides={"scale": "smoke"}), of_processor())


@pytest.fixture(scope="session")
def recipe_of(settings):
    """The same as the library's, for the methods of sweeps too."""
    return recipes(settings, Catalogue(settings).all_methods)
