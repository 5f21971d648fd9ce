"""By which inputs a hit enters a prediction: walks with and without it, with their inputs exchanged."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from experiments.evaluation.measure.learning import paths
from experiments.evaluation.measure.learning.paths import EVERY, GROUPS, INPUTS, mix, taken_by_inputs
from experiments.evaluation.measure.learning.trials import ObservedWalks
from experiments.plan.runs import Tried
from experiments.settings.settings import Settings
from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.core.joints import NQ_BASE, JointLayout
from mobnet.core.recording import Recording, Sensed
from mobnet.estimation.estimate import ObservedRecording

JOINT, FIRST, LAST, ROWS = "LL3", 1000, 1080, 1500
BROUGHT = {"desired torque": 0.4, "inertial sensor": 0.3, "positions": 0.0, "velocities": -0.1}  # of a hit, by inputs


FELT = ("v", "acc_base_in_base", "tau_des")  # signals that feel a hit in all their columns


def struck(sensed: Sensed, by: np.ndarray) -> Sensed:
    """Return a walk in which a hit (T,) is felt by every signal; an orientation of any other length is none."""
    q = sensed.q.copy()
    q[:, NQ_BASE:] += by[:, None]
    return replace(sensed, q=q, **{name: getattr(sensed, name) + by[:, None] for name in FELT})


@pytest.fixture
def walks(
    settings: Settings, layout: JointLayout, made_up: Any, monkeypatch: pytest.MonkeyPatch
) -> tuple[ObservedWalks, list[tuple[Path, Path]]]:
    """A walk with a hit, and its twin without."""
    twin: Recording = made_up(seconds=1.5)
    hit = np.zeros(ROWS)
    hit[FIRST:LAST] = 30.0 * np.sin(np.linspace(0.0, np.pi, LAST - FIRST))
    monkeypatch.setattr(paths, "read_sensed", lambda *_: twin)
    monkeypatch.setattr(paths, "push_windows", lambda *_: ((FIRST, LAST + 50),))
    residual = np.zeros((ROWS, len(layout.names)), dtype=np.float32)
    read = ObservedRecording(replace(twin, sensed=struck(twin.sensed, hit)), residual)
    level: Any = type("AsItIs", (), {"nominal_mass_ratio": 1.0})
    known = settings.robot, settings.plant.gravity_m_s2, settings.observer
    return ObservedWalks(*known, level, [JOINT], [read], [hit[:, None]]), [(Path("hit"), Path("twin"))]


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch, layout: JointLayout) -> None:
    """A network whose prediction is a sum of one signal of each group of inputs."""
    column = layout.columns([JOINT])[0]

    def run(_: Any, read: list[ObservedRecording]) -> list[Estimate]:
        found: list[Estimate] = []
        for one in read:
            sensed = one.recording.sensed
            signals = {
                "positions": sensed.q[:, -1],
                "velocities": sensed.v[:, -1],
                "desired torque": sensed.tau_des[:, 0],
                "inertial sensor": sensed.acc_base_in_base[:, 0],
            }
            predicted = np.zeros(len(sensed))
            for name, signal in signals.items():
                predicted += BROUGHT[name] * signal
            assert one.residual is not None
            found.append(Estimate((one.residual[:, column] - predicted)[:, None], None))
        return found

    monkeypatch.setattr(paths, "run_segments", run)
    monkeypatch.setattr(paths, "estimator_of", lambda *_: type("Network", (), {"joints": (JOINT,)}))


@pytest.fixture
def tried(settings: Settings) -> Tried:
    """What stands for the network."""
    return Tried("MOB", "MOB", {}, {"MOB": settings.methods["MOB"]}, {}, None, 0)


@pytest.mark.usefixtures("network")
def test_each_input_brings_in_its_share_of_a_hit(
    walks: tuple[ObservedWalks, list[tuple[Path, Path]]], tried: Tried
) -> None:
    found = taken_by_inputs(tried, *walks, 0.05, JOINT)
    assert set(found) == set(GROUPS)
    for name in INPUTS:
        assert found[name] == pytest.approx(BROUGHT[name], abs=1e-3)
    assert found[EVERY] == pytest.approx(sum(BROUGHT.values()), abs=1e-3)


@pytest.mark.usefixtures("network")
def test_walks_that_differ_before_the_hit_are_refused(
    walks: tuple[ObservedWalks, list[tuple[Path, Path]]],
    tried: Tried,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(paths, "push_windows", lambda *_: ((FIRST + 10, LAST),))  # the hit begins before this
    with pytest.raises(DataError, match="twin: differs from hit before the first hit"):
        taken_by_inputs(tried, *walks, 0.05, JOINT)


def test_only_the_named_inputs_are_exchanged(made_up: Any) -> None:
    twin: Sensed = made_up(seconds=0.01).sensed
    hit = struck(twin, np.ones(10, dtype=np.float32))
    mixed = mix(twin, hit, ["desired torque"])
    np.testing.assert_array_equal(mixed.tau_des, hit.tau_des)
    for name in ("q", "v", "acc_base_in_base", "tau_motor"):
        np.testing.assert_array_equal(getattr(mixed, name), getattr(twin, name))
    whole = mix(twin, hit, INPUTS)
    for name in ("q", "v", "acc_base_in_base", "tau_des"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(hit, name))
