"""What a training depends on."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import torch

from mobnet.core.errors import ConfigError
from mobnet.learning.job import Job, job_of


@pytest.fixture
def job(full_config: dict[str, Any]) -> Job:
    return replace(job_of(full_config, "MOB-Net", "LL", 0), epochs=200)


def test_rate_falls_linearly_to_a_hundredth_over_the_first_half_at_the_papers_size(full_config: dict[str, Any]) -> None:
    job = job_of(full_config | {"sizes": full_config["scales"]["paper"]}, "MOB-Net", "LL", 0)
    rates = np.array([job.rate(epoch) for epoch in range(200)])
    assert rates[0] == 0.005
    np.testing.assert_allclose(np.diff(rates[:101]), -0.005 * 0.99 / 100)
    np.testing.assert_allclose(rates[100:], 5e-5)


def test_rate_of_a_short_run_falls_to_its_very_end(full_config: dict[str, Any]) -> None:
    """At 20 epochs the share of the default scale ends with the last epoch but one."""
    job = replace(job_of(full_config | {"sizes": full_config["scales"]["default"]}, "MOB-Net", "LL", 0), epochs=20)
    rates = np.array([job.rate(epoch) for epoch in range(job.epochs)])
    assert (np.diff(rates) < 0).all()
    np.testing.assert_allclose(rates[[0, -1]], [0.005, 5e-5])


def test_one_epoch_trains_at_the_first_rate(job: Job) -> None:
    assert replace(job, epochs=1).rate(0) == 0.005


def test_sizes_of_the_scale_lie_over_the_settings(full_config: dict[str, Any]) -> None:
    sizes = {"experiments": {"left_leg": {"epochs": 3, "seeds": [0]}}, "batch_size": 2}
    job = job_of(full_config | {"sizes": sizes}, "MOB-Net", "LL", 0)
    assert (job.epochs, job.settings["batch_size"]) == (3, 2)
    assert job.settings["stream_s"] == full_config["learning"]["stream_s"]


@pytest.mark.parametrize("rate_hz", [1000.0, 500.0, 0.1])
def test_a_stream_is_whole_horizons_and_at_least_one(job: Job, rate_hz: float) -> None:
    stream = job.stream(rate_hz)
    assert stream % job.horizon == 0
    assert stream == max(job.horizon, round(job.settings["stream_s"] * rate_hz))


def test_random_numbers_differ_by_purpose_and_repeat(job: Job) -> None:
    draws = {p: job.generator(*p).integers(1 << 60) for p in [("epoch", 0), ("epoch", 1), ("weights",)]}
    assert len(set(draws.values())) == len(draws)
    assert job.generator("epoch", 0).integers(1 << 60) == draws["epoch", 0]
    assert replace(job, seed=1).generator("epoch", 0).integers(1 << 60) != draws["epoch", 0]


def test_methods_share_which_data_they_learn_from(job: Job) -> None:
    other = replace(job, method="FTS-e2e")
    assert job.shared_generator("data").integers(1 << 60) == other.shared_generator("data").integers(1 << 60)
    assert job.generator("data").integers(1 << 60) != other.generator("data").integers(1 << 60)
    again = replace(job, seed=1)
    assert again.shared_generator("data").integers(1 << 60) != job.shared_generator("data").integers(1 << 60)


@pytest.mark.parametrize(
    "change", [{"seed": 1}, {"epochs": 9}, {"settings": {"precision": "auto"}}, {"target": "external"}]
)
def test_fingerprint_changes_with_the_job(job: Job, change: dict[str, Any]) -> None:
    cpu = torch.device("cpu")
    assert job.fingerprint("data", cpu) == job.fingerprint("data", cpu)
    assert job.fingerprint("data", cpu) != replace(job, **change).fingerprint("data", cpu)
    assert job.fingerprint("data", cpu) != job.fingerprint("other", cpu)


def test_fingerprint_depends_on_the_number_format_in_use(job: Job, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same configuration, on a CPU with bfloat16 and on one without."""
    found = []
    for has in (True, False):
        monkeypatch.setattr(torch.cpu, "get_capabilities", lambda has=has: {"avx512_bf16": has})
        found.append((job.precision(torch.device("cpu")), job.fingerprint("data", torch.device("cpu"))))
    assert [precision for precision, _ in found] == [torch.bfloat16, torch.float32]
    assert found[0][1] != found[1][1]


@pytest.mark.parametrize("cell", ["LSTM", "RNN", "TCN", "MLP", "constant"])
def test_only_a_gru_has_bfloat16_products(job: Job, cell: str) -> None:
    settings = {**job.settings, "precision": "bfloat16"}
    assert replace(job, settings=settings).precision(torch.device("cpu")) == torch.bfloat16
    other = replace(job, settings=settings, row={**job.row, "cell": cell})
    assert other.precision(torch.device("cpu")) == torch.float32


def test_unknown_names_are_refused(full_config: dict[str, Any]) -> None:
    with pytest.raises(ConfigError, match="'MOB' is not accepted; accepted: FTS-e2e, "):
        job_of(full_config, "MOB", "LL", 0)
    with pytest.raises(ConfigError, match="'tail' is not accepted"):
        job_of(full_config, "MOB-Net", "tail", 0)
