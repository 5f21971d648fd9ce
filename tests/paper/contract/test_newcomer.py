"""The worked example of CONTRIBUTING.md: one file and one row make an estimator that keeps the contract."""

import re
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest
import yaml

from experiments.jobs.method_problems import method_problems
from experiments.settings.catalogue import Catalogue
from experiments.settings.load import load_settings
from mobnet.estimation import kinds
from mobnet.estimation.kinds import build_estimator

from .checks import CHECKS

ROOT = Path(__file__).parents[3]
NAME = "MOB-quiet"


def example(language):
    """Return the only block of a language on the guide's page of methods."""
    page = (ROOT / "CONTRIBUTING.md").read_text().split("\n## Add a method")[1].split("\n## ")[0]
    (block,) = re.findall(rf"^ *```{language}\n(.*?)^ *```$", page, re.DOTALL | re.M)
    return textwrap.dedent(block)


@pytest.fixture(scope="module")
def extended():
    return load_settings(overrides={"scale": "smoke", "methods": yaml.safe_load(example("yaml"))})


@pytest.fixture
def added(tmp_path, monkeypatch):
    """The example's file among the kinds."""
    (tmp_path / "dead_band.py").write_text(example("python"))
    monkeypatch.setattr(kinds, "__path__", [*kinds.__path__, str(tmp_path)])
    yield
    sys.modules.pop(f"{kinds.__name__}.dead_band", None)


@pytest.fixture
def estimator(extended, recipe_of, added):
    return build_estimator(recipe_of(NAME, methods=extended.methods))


@pytest.mark.usefixtures("added")
def test_one_file_and_one_row_are_accepted_beside_all_other_methods(extended):
    assert not list(method_problems(extended))
    wide = Catalogue(extended).method(NAME).model_copy(update={"options": {"width_nm": -2.0}})
    (fault,) = method_problems(extended.model_copy(update={"methods": {**extended.methods, NAME: wide}}))
    place = ("methods", NAME, "options", "width_nm")
    assert fault == (place, "-2.0 is not accepted; accepted: a number above 0")


def test_without_its_file_the_kind_is_named(extended):
    ((place, text),) = method_problems(extended)
    assert place == ("methods", NAME, "kind")
    assert text.startswith("kind: 'dead_band' is not accepted; accepted: ")


@pytest.mark.parametrize("check", CHECKS, ids=[check.__name__ for check in CHECKS])
def test_the_example_keeps_the_contract(check, estimator, sensed):
    check(estimator, sensed)


def test_the_example_does_what_it_says(extended, recipe_of, estimator, sensed):
    """The residual, nearer to zero by the band's half width."""
    residual, quiet = (made.estimate(sensed).tau_ext for made in (build_estimator(recipe_of("MOB")), estimator))
    width = Catalogue(extended).method(NAME).options["width_nm"]
    np.testing.assert_allclose(np.abs(residual - quiet), np.minimum(np.abs(residual), width), atol=1e-9)
