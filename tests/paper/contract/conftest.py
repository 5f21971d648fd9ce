"""Untrained networks and small fits on disk, for every method of the configuration."""

import json

import pytest
import torch
from library_settings import recipes
from made_notes import network_note
from paper_settings import settings_at
from safetensors.torch import save_file

from experiments.jobs.fitting import write_fit
from experiments.plan.plan import with_precision
from experiments.settings.catalogue import Catalogue
from mobnet.core.files import WEIGHTS
from mobnet.estimation.kinds import build_estimator
from mobnet.learning.deployed.weights import NOTE
from mobnet.learning.features import limb_inputs
from mobnet.learning.model import build_network
from mobnet.learning.precision import of_processor

SECONDS, FIT_SECONDS = 0.15, 0.3
INPUT_STD, TARGET_STD = 2.0, 10.0


@pytest.fixture(scope="session")
def settings():
    """The configuration at a scale that tries every value of its sweeps."""
    return with_precision(settings_at("quick"), of_processor())


@pytest.fixture(scope="session")
def recipe_of(settings):
    """The same as elsewhere, for all of these methods."""
    return recipes(settings, Catalogue(settings).all_methods)


@pytest.fixture(scope="session")
def learned(settings, made_up, write_pair, tmp_path_factory):
    """Return a function of (method, zero) that writes random or zero networks, or a fit to a few samples."""

    def made(method, zero=False):
        folder, catalogue = tmp_path_factory.mktemp(method), Catalogue(settings)
        source, learned = catalogue.source_of(method), catalogue.network_source_of(method)
        row, networks = catalogue.method(source), {limb: folder / limb for limb in catalogue.method(learned).limbs}
        for limb, place in networks.items():
            _write_network(place, catalogue.training(learned, limb), settings.layout, zero)
        fitted = folder / "fit.json" if row.fitted else None
        if fitted is not None:
            pair = write_pair(folder, made_up(1, FIT_SECONDS))
            limbs = {limb: catalogue.network(source, limb) for limb in row.fitted}
            write_fit(settings.layout, settings.observer, row, limbs, dict.fromkeys(limbs, (pair,)), fitted)
        return networks, fitted

    return made


@pytest.fixture(scope="session")
def build(recipe_of, learned):
    """Return a function of (method, zero) that builds it with what `learned` writes."""

    def made(method, zero=False):
        networks, fitted = learned(method, zero)
        return build_estimator(recipe_of(method, networks=networks, fitted=fitted))

    return made


@pytest.fixture(scope="session")
def sensed(made_up):
    return made_up(5, SECONDS).sensed


def _write_network(folder, training, layout, zero):
    """Write an untrained network; a zero one predicts no uncertainty."""
    network, std_min = training.network, training.learning.std_min
    joints, names = layout.limbs(network.joints), limb_inputs(layout, network).names
    module = build_network(network, len(names), len(joints), std_min, seed=len(training.limb))
    tensors = {name: tensor * (not zero) for name, tensor in module.deployable().items()}
    for name, count, std in (("input", len(names), INPUT_STD), ("target", len(joints), TARGET_STD)):
        tensors |= {f"{name}.mean": torch.zeros(count), f"{name}.std": torch.full((count,), std)}
    cell = network.model_dump(mode="json", exclude_defaults=True)
    note = network_note(training.limb, joints, names, cell, std_min)
    folder.mkdir()
    save_file(tensors, folder / WEIGHTS, {NOTE: json.dumps(note)})
