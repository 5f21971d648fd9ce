"""The rates of a GPU: two numbers fit what was measured, and what a training takes follows from them."""

from pathlib import Path

import pytest

from experiments.plan.gpu import GPU_RATES, GpuNote, GpuRates, fitted
from experiments.plan.work import OnGpu
from mobnet.core.notes import read_note

ROOT = Path(__file__).parents[3]


@pytest.fixture
def gpu() -> GpuRates:
    """The committed rates."""
    return fitted(read_note(ROOT / GPU_RATES, GpuNote))


def test_two_numbers_fit_what_was_measured(gpu: GpuRates) -> None:
    """An update of 50 steps takes 1.1 ms, and .08 ms more for each network of a leg."""
    assert gpu.start_s == pytest.approx(1.12e-3, abs=0.01e-3)
    assert gpu.network_s == pytest.approx(0.082e-3, abs=0.001e-3)
    note = gpu.note
    for count, speed in note.side_by_side.items():
        steps = int(count) * note.batch * note.horizon
        fitted_speed = steps / gpu.update_s(int(count), note.units, note.batch, note.horizon)
        assert fitted_speed == pytest.approx(speed, rel=0.12), count


def test_networks_on_recordings_learn_nearly_as_fast(gpu: GpuRates) -> None:
    """They were no part of the fit."""
    ((count, speed),) = gpu.note.trained.items()
    note = gpu.note
    steps = int(count) * note.batch * note.horizon
    assert speed > 0.85 * steps / gpu.update_s(int(count), note.units, note.batch, note.horizon)


def test_a_training_takes_its_updates(gpu: GpuRates) -> None:
    """Twice the steps of an update take twice its time, and more units or sequences of a network that much longer."""
    leg = OnGpu(networks=8, steps=3200.0 * 1000, all_steps=8 * 3200.0 * 1000, units=150, batch=64, horizon=50)
    assert gpu.seconds(leg) == pytest.approx(1000 * (gpu.start_s + 8 * gpu.network_s))
    longer = OnGpu(8, leg.steps, leg.all_steps, 150, 64, 100)
    assert gpu.seconds(longer) == pytest.approx(gpu.seconds(leg))
    wide = OnGpu(8, leg.steps, leg.all_steps, 300, 32, 50)
    assert gpu.seconds(wide) == pytest.approx(2 * gpu.seconds(leg))
    alone = OnGpu(0, leg.steps, leg.steps, 128, 64, 50)
    assert gpu.seconds(alone) == pytest.approx(leg.steps / gpu.note.alone)
    assert (leg.all_steps, alone.all_steps) == (8 * leg.steps, leg.steps)


def test_the_rates_say_that_they_are_of_other_code(gpu: GpuRates) -> None:
    assert "prototype" in gpu.note.made_by
