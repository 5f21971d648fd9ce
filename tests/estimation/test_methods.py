"""From a method of the configuration to an estimator, and methods that make none."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from mobnet.core.code import SOURCE, reached, start_of
from mobnet.core.errors import ConfigError, DataError
from mobnet.estimation.kinds.residual import ResidualEstimator
from mobnet.estimation.methods import build_estimator, check_methods, kind_names
from mobnet.estimation.recipe import Recipe
from mobnet.settings.methods import Method
from mobnet.settings.settings import Settings

HEAVY = {"torch", "pinocchio", "numba", "scipy.signal", "scipy.optimize"}
FRICTION = {"terms": ["coulomb"], "smoothing_rad_s": 0.02, "stribeck_rad_s": [0.1]}
CHECK = """
import sys
from mobnet.estimation.methods import check_methods
from mobnet.settings.load import load_settings
check_methods(load_settings().methods)
print(*sys.modules)
"""
TERMS = "input should be 'coulomb', 'static', 'viscous' or 'load'"


def test_mob_estimates_every_joint(recipe_of: Callable[..., Recipe]) -> None:
    estimator = build_estimator(recipe_of("MOB"))
    assert isinstance(estimator, ResidualEstimator)
    assert len(estimator.joints) == 39


def test_missing_weights_are_named(recipe_of: Callable[..., Recipe], tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"weights\.safetensors: file is missing"):
        build_estimator(recipe_of("FTS-e2e", networks={"LL": tmp_path, "RL": tmp_path}))


def test_the_configured_methods_are_accepted(settings: Settings) -> None:
    check_methods(settings.all_methods)
    assert {"band_pass", "direct", "friction", "residual"} <= set(kind_names())


@pytest.mark.parametrize(
    ("kind", "options", "message"),
    [
        ("magic", {}, "kind: 'magic' is not accepted; accepted: .*residual"),
        ("residual", {"gain": 1.0}, "options.gain: key: 'gain' is not accepted; accepted: $"),
        ("band_pass", {"band_hz": [15.0, 2.0], "order": 2}, "options.band_hz: the lower end must come first"),
        ("band_pass", {"band_hz": [2.0, 15.0]}, "options.order: key is missing"),
        ("band_pass", {"band_hz": [2.0, 15.0], "order": 0}, "options.order: 0 is not accepted; .* equal to 1"),
        ("friction", {**FRICTION, "terms": ["coulomb", "glue"]}, f"options.terms.1: 'glue' is not accepted; {TERMS}"),
        ("friction", {**FRICTION, "terms": ["load", "load"]}, "options.terms: each value may occur once"),
        ("friction", {**FRICTION, "terms": []}, r"options.terms: \[\] is not accepted; .* at least 1 item"),
        ("friction", {**FRICTION, "smoothing_rad_s": 0.0}, "options.smoothing_rad_s: 0.0 is not accepted; .* than 0"),
        ("friction", {**FRICTION, "stribeck_rad_s": [-1.0]}, r"options.stribeck_rad_s.0: -1.0 is not accepted; .* 0"),
    ],
)  # fmt: skip
def test_a_kind_or_an_option_that_is_not_accepted_is_one_line(
    kind: str, options: dict[str, object], message: str
) -> None:
    with pytest.raises(ConfigError, match=rf"^methods\.b\.{message}"):
        check_methods({"a": Method(kind="residual"), "b": Method.model_validate({"kind": kind, "options": options})})


def test_all_faults_of_all_methods_are_told_at_once() -> None:
    bad = {"a": Method(kind="magic"), "b": Method(kind="band_pass"), "c": Method(kind="residual")}
    with pytest.raises(ConfigError) as caught:
        check_methods(bad)
    places = [line.split(": ")[0] for line in str(caught.value).splitlines()]
    assert places == ["methods.a.kind", "methods.b.options.band_hz", "methods.b.options.order"]


def test_the_check_imports_nothing_heavy() -> None:
    """The workflow checks methods whenever it starts."""
    done = subprocess.run([sys.executable, "-c", CHECK], check=True, capture_output=True, text=True)
    assert not HEAVY & set(done.stdout.split())


def test_an_estimate_does_not_depend_on_how_networks_are_trained(settings: Settings) -> None:
    """The code hash of an estimate covers networks as they run, and neither their training nor other kinds."""
    kinds = [f"mobnet.estimation.kinds.{name}" for name in ("residual", "direct")]
    starts = frozenset(start_of(name) for name in ("mobnet.estimation.estimate", *kinds))
    files = {file.relative_to(SOURCE) for source in reached(starts) for file in source.files}
    learning = {file.stem for file in files if "learning" in file.parts} - {"__init__"}
    assert learning == {"features", "limbs", "networks", "weights", "module_network", "model", "cells", "gru", "gates"}
    assert not {file.stem for file in files} & {"friction", "band_pass", "regression"}
