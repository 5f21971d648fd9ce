"""From a method of the configuration to an estimator, and methods that make none."""

import re
import subprocess
import sys

import pytest

from experiments.jobs.method_problems import method_problems
from mobnet.core.code import SOURCE, part_of, reached
from mobnet.core.errors import DataError
from mobnet.estimation.kinds import build_estimator, kind_names
from mobnet.estimation.residual import ResidualEstimator
from mobnet.formats.reading import dotted
from mobnet.settings.methods import Method

HEAVY = {"torch", "pinocchio", "numba", "scipy.signal", "scipy.optimize"}
FRICTION = {"terms": ["coulomb"], "smoothing_rad_s": 0.02, "stribeck_rad_s": [0.1]}
CHECK = """
import sys
from experiments.jobs.method_problems import method_problems
from experiments.settings.load import load_settings
load_settings(further=method_problems)
print(*sys.modules)
"""
TERMS = "accepted: 'coulomb', 'static', 'viscous', 'load'"


def told(settings, methods):
    """Return what is not accepted in some methods, a line for each fault."""
    rows = {name: Method.model_validate({"kind": "residual", **row}) for name, row in methods.items()}
    found = method_problems(settings.model_copy(update={"methods": rows}))
    return [f"{dotted(place)}: {text}" for place, text in found]


def test_mob_estimates_every_joint(recipe_of):
    estimator = build_estimator(recipe_of("MOB"))
    assert isinstance(estimator, ResidualEstimator)
    assert len(estimator.joints) == 39


def test_missing_weights_are_named(recipe_of, tmp_path):
    with pytest.raises(DataError, match=r"weights\.safetensors: file is missing"):
        build_estimator(recipe_of("FTS-e2e", networks={"LL": tmp_path}))


def test_the_configured_methods_are_accepted(settings):
    assert not list(method_problems(settings))
    assert {"band_pass", "direct", "friction", "residual"} <= set(kind_names())


@pytest.mark.parametrize(("kind", "options", "message"), [
    ("magic", {}, "kind: kind: 'magic' is not accepted; accepted: .*residual"),
    ("residual", {"gain": 1.0}, "options.gain: key: 'gain' is not accepted; accepted: none"),
    ("band_pass", {"band_hz": [15.0, 2.0], "order": 2}, "options.band_hz: .* accepted: two numbers, the lower one"),
    ("band_pass", {"band_hz": [2.0, 15.0]}, "options.order: key is missing; accepted: a whole number from 1"),
    ("band_pass", {"band_hz": [2.0, 15.0], "order": 0}, "options.order: 0 is not accepted; accepted: .* from 1"),
    ("band_pass", {"band_hz": [2.0, 501.0], "order": 2}, "options.band_hz.1: 501.0 is not accepted; .* 500.0"),
    ("friction", {**FRICTION, "terms": ["coulomb", "glue"]}, f"options.terms.1: 'glue' is not accepted; {TERMS}"),
    ("friction", {**FRICTION, "terms": ["load", "load"]}, "options.terms: .* is not accepted; .*each value once"),
    ("friction", {**FRICTION, "terms": []}, r"options.terms: \[\] is not accepted; accepted: a list of 1 or more"),
    ("friction", {**FRICTION, "smoothing_rad_s": 0.0}, "options.smoothing_rad_s: 0.0 is not accepted; accepted"),
    ("friction", {**FRICTION, "stribeck_rad_s": [-1.0]}, r"options.stribeck_rad_s.0: -1.0 is not accepted; acc"),
    ("friction", FRICTION, "fitted: .* is not accepted; accepted: limbs to fit"),
    ("dahl", {}, "options.breakaway_rad: key is missing; accepted: a list of 1 or more"),
    ("dahl", {"breakaway_rad": []}, r"options.breakaway_rad: \[\] is not accepted; accepted: a list of 1 or more"),
    ("dahl", {"breakaway_rad": [0.0]}, "options.breakaway_rad.0: 0.0 is not accepted; accepted: "),
    ("dahl", {"breakaway_rad": [0.004, 0.002]}, "options.breakaway_rad: .* accepted: numbers that rise"),
    ("dahl", {"breakaway_rad": [0.004], "terms": ["load"]}, "options.terms: key: 'terms' is not accepted; accepted: "),
    ("dahl", {"breakaway_rad": [0.004]}, "fitted: .* is not accepted; accepted: limbs to fit"),
])  # fmt: skip
def test_a_kind_or_an_option_that_is_not_accepted_is_one_line(settings, kind, options, message):
    row = {"of": "a"} if kind == "band_pass" else {}
    (line,) = told(settings, {"a": {}, "b": {"kind": kind, "options": options, **row}})
    assert re.match(rf"methods\.b\.{message}", line)


def test_all_faults_of_all_methods_are_told_at_once(settings):
    learned = {"kind": "direct", "target": "uncertainty", "limbs": ["LL"]}
    lines = told(settings, {"a": {"kind": "magic"}, "b": {"kind": "band_pass"}, "c": {}, "d": learned})
    places = [line.split(": ")[0] for line in lines]
    assert places == ["methods.a.kind", "methods.b.options.band_hz", "methods.b.options.order", "methods.d.target"]


def test_the_check_imports_nothing_heavy():
    """The workflow checks methods whenever it starts."""
    done = subprocess.run([sys.executable, "-c", CHECK], check=True, capture_output=True, text=True)
    assert not HEAVY & set(done.stdout.split())


def test_an_estimate_does_not_depend_on_how_networks_are_trained(settings):
    """The code hash of an estimate covers networks as they run, and neither their training nor other kinds."""
    kinds = [f"mobnet.estimation.kinds.{name}" for name in ("residual", "direct")]
    starts = frozenset(part_of(name) for name in ("mobnet.estimation.estimate", *kinds))
    files = {file.relative_to(SOURCE) for source in reached(starts) for file, *_ in source.parts}
    learning = {file.stem for file in files if "learning" in file.parts} - {"__init__"}
    run = {"features", "limbs", "lanes", "loading", "networks", "tensors", "weights", "module_network", "tick"}
    assert learning == run | {"model", "cells", "gru", "gates", "tiles"}
    assert not {file.stem for file in files} & {"friction", "dahl", "band_pass", "regression"}
