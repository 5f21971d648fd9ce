"""Random numbers, learning rates, number format and fingerprint of a repetition of a training."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from library_settings import training_of

from mobnet.core.errors import ConfigError
from mobnet.learning.job import PRECISIONS, TrainingJob, precision_name, precision_of

CPU, GPU = torch.device("cpu"), torch.device("cuda")


@pytest.fixture
def job(settings):
    return TrainingJob(training_of(settings, "MOB-Net", "LL"), seed=0, root_seed=2023)


def changed(job, **values):
    """Return a job whose training, network or learning has other values."""
    parts = {name: getattr(job.training, name) for name in ("network", "learning")}
    training = {key: value for key, value in values.items() if key in type(job.training).model_fields}
    for name, part in parts.items():
        training[name] = part.model_copy(update={k: v for k, v in values.items() if k in type(part).model_fields})
    return replace(job, training=job.training.model_copy(update=training))


def test_rate_of_a_short_run_falls_to_its_very_end(job, settings):
    """At 20 epochs the share of the default scale ends with the last epoch but one."""
    short = changed(job, epochs=20)
    rates = np.array([short.rate(epoch) for epoch in range(20)])
    assert (np.diff(rates) < 0).all()
    first = settings.learning.rate_first
    np.testing.assert_allclose(rates[[0, -1]], [first, first / 100])
    assert changed(job, epochs=1).rate(0) == first


@pytest.mark.parametrize("rate_hz", [1000.0, 500.0, 0.1])
def test_a_stream_is_whole_horizons_and_at_least_one(job, rate_hz):
    stream = job.stream(rate_hz)
    assert stream % job.horizon == 0
    assert stream == max(job.horizon, round(job.training.learning.stream_s * rate_hz))


def test_random_numbers_differ_by_purpose_and_repeat(job):
    draws = {p: job.generator(*p).integers(1 << 60) for p in [("epoch", 0), ("epoch", 1), ("weights",)]}
    assert len(set(draws.values())) == len(draws)
    assert job.generator("epoch", 0).integers(1 << 60) == draws["epoch", 0]
    assert replace(job, seed=1).generator("epoch", 0).integers(1 << 60) != draws["epoch", 0]


def test_methods_share_which_data_they_learn_from(job):
    other, again = changed(job, method="FTS-e2e"), replace(job, seed=1)
    shared = [run.shared_generator("data").integers(1 << 60) for run in (job, other, again)]
    assert shared[0] == shared[1] != shared[2]
    assert job.generator("data").integers(1 << 60) != other.generator("data").integers(1 << 60)


@pytest.mark.parametrize("change", [{"epochs": 9}, {"rate_first": 0.1}, {"hidden": 9}, {"target": "external"}])
def test_fingerprint_changes_with_the_training(job, change):
    assert job.fingerprint("data", CPU) == job.fingerprint("data", CPU)
    assert job.fingerprint("data", CPU) != changed(job, **change).fingerprint("data", CPU)


def test_fingerprint_changes_with_seeds_data_and_the_number_format(job):
    others = [replace(job, seed=1).fingerprint("data", CPU), replace(job, root_seed=1).fingerprint("data", CPU)]
    assert len({job.fingerprint("data", CPU), job.fingerprint("other", CPU), *others}) == 4
    one, other = (changed(job, precision=name) for name in PRECISIONS)
    assert other.fingerprint("data", CPU) != one.fingerprint("data", CPU) != one.fingerprint("data", GPU)


@pytest.mark.parametrize("cell", ["LSTM", "RNN", "TCN", "MLP", "constant"])
def test_only_a_gru_has_bfloat16_products(job, cell):
    gru = changed(job, precision="bfloat16")
    assert gru.precision(CPU) == torch.bfloat16
    assert changed(gru, cell=cell).precision(CPU) == torch.float32


@pytest.mark.parametrize("name", PRECISIONS)
def test_a_named_format_is_that_format_and_a_gpu_computes_in_float32(name):
    assert precision_name(precision_of(name, CPU)) == name
    assert precision_of(name, GPU) == torch.float32


def test_auto_names_no_format_of_a_training():
    """What it stands for is decided once for all trainings (`experiments.plan.plan`)."""
    with pytest.raises(ConfigError, match=r"precision of a training: 'auto' is not accepted; accepted: bfloat"):
        precision_of("auto", CPU)
