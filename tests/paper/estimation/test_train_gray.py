"""A gray box learns what its friction model leaves, and the fit reaches nothing else of the training."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from jobs_of import network, reads

from experiments.jobs.fitting import filtered_friction, write_fit
from experiments.jobs.trainings import train
from experiments.plan.plan import make_plan
from experiments.settings.catalogue import Catalogue
from mobnet.estimation.kinds import build_estimator
from mobnet.estimation.kinds.friction import read_friction
from mobnet.learning.dataset import load_limb_data

METHOD, LIMB = "MOB-Net-gray", "LL"


@pytest.fixture
def pair(tmp_path, made_up, write_pair):
    return write_pair(tmp_path, made_up(1, 2.0, segments=2))


@pytest.fixture
def fitted(settings, tmp_path, pair):
    """A fit of the method that the gray box builds upon."""
    source = Catalogue(settings).source_of(METHOD)
    row = Catalogue(settings).method(source)
    limbs = {limb: Catalogue(settings).network(source, limb) for limb in row.fitted}
    write_fit(settings.layout, settings.observer, row, limbs, dict.fromkeys(limbs, (pair,)), tmp_path / "fit.json")
    return tmp_path / "fit.json"


def test_the_target_lacks_what_the_method_subtracts_that_it_builds_upon(settings, recipe_of, made_up, pair, fitted):
    """By MOB - MOB-fric-load, segment by segment; so the gray box's target is the error of MOB-fric-load."""
    layout, training = settings.layout, Catalogue(settings).training(METHOD, LIMB)
    friction = read_friction(fitted, layout.actuated)

    def known(recording, joints):
        return filtered_friction(layout, friction, settings.observer.gain_hz, recording, joints)

    given = layout, training.network, training.target, [pair[0]], [pair[1]]
    whole, left = load_limb_data(*given), load_limb_data(*given, known=known)
    np.testing.assert_array_equal(whole.inputs, left.inputs)
    methods = [build_estimator(recipe_of(name, fitted=fit)) for name, fit in (("MOB", None), ("MOB-fric-load", fitted))]
    recording, where = made_up(1, 2.0, segments=2), layout.columns(left.joints)
    for span in recording.spans():
        residual, less = (method.estimate(recording.sensed[span]).tau_ext[:, where] for method in methods)
        found = whole.targets[span] - left.targets[span]
        np.testing.assert_allclose(found, residual - less, atol=1e-3)
        assert np.abs(found).max() > 1.0


def test_the_base_has_no_friction(settings, pair, fitted):
    friction = read_friction(fitted, settings.layout.actuated)
    found = filtered_friction(settings.layout, friction, 100.0, pair[0], ["V1", "LL1"])
    assert found.shape == (2000, 2)
    assert not found[:, 0].any()
    assert found[:, 1].any()


def test_it_trains(settings, pair, fitted, tmp_path):
    training = Catalogue(settings).training(METHOD, LIMB)
    small = {
        "network": training.network.model_copy(update={"hidden": 8, "horizon_steps": 25}),
        "learning": training.learning.model_copy(update={"stream_s": 0.5, "batch_size": 4}),
        "epochs": 1, "epoch_samples": None,
    }  # fmt: skip
    given = settings.layout, training.model_copy(update=small), 0, [pair[0]], [pair[1]]
    train(1, *given, tmp_path / "state", tmp_path / "out", observer=settings.observer, fitted=fitted)
    note = json.loads((tmp_path / "out" / "run.json").read_text())
    assert (note["method"], note["target"]) == (METHOD, "uncertainty")


def test_a_training_reads_the_fit_that_it_builds_upon_and_no_other_does(settings):
    plan = make_plan(settings, with_pdf=False)
    gray = reads(plan, "train", **network(f"{METHOD}-{LIMB}-s0"))
    plain = reads(plan, "train", **network(f"MOB-Net-{LIMB}-s0"))
    assert [name for name in gray if "/fits/" in name] == ["results/smoke/plant/fits/MOB-fric-load.json"]
    assert not [name for name in plain if "/fits/" in name]
    modules = [plan.jobs.trained_by(SimpleNamespace(robot="plant", method=name)) for name in (METHOD, "MOB-Net")]
    assert modules == [["experiments.jobs.fitting"], []]
    test = {"robot": "plant", "scenario": "hip_pitch_step", "level": "all_uncertainty"}
    estimated = reads(plan, "estimate", **test)
    assert "results/smoke/plant/fits/MOB-fric-load.json" in estimated
    assert "results/smoke/plant/networks/MOB-Net-gray-LL-s0/weights.safetensors" in estimated
    modules = plan.jobs.estimated_by(SimpleNamespace(**test))
    assert {"mobnet.estimation.kinds.gray", "mobnet.estimation.kinds.friction"} <= set(modules)
