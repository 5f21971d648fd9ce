"""The observer of a simulated walk is as good as the paper says."""

import numpy as np
import pytest

from experiments.jobs.observing import observe
from mobnet.core.store import read_array
from mobnet.simulation.record import collect


@pytest.mark.sim
@pytest.mark.slow
def test_residual_of_the_ideal_level_meets_table_5(walk_of, settings, layout, tmp_path):
    collect(walk_of("forward_walk", "ideal"), 1, 10.0, tmp_path / "s1")
    gravity, level = settings.plant.gravity_m_s2, settings.levels["ideal"]
    observe(settings.robot, level, gravity, settings.observer, tmp_path / "s1", tmp_path / "r1")
    array, _ = read_array(tmp_path / "r1")
    residual, truth = np.split(np.asarray(array, dtype=float), 2, axis=1)
    rmse = dict(zip(layout.names, np.sqrt(np.mean((residual - truth) ** 2, axis=0)), strict=True))
    mean = {limb: np.mean([rmse[joint] for joint in layout.limb(limb)]) for limb in ("LL", "RL", "W", "LA", "RA")}
    assert max(mean.values()) <= 0.02
    assert max(rmse[joint] for joint in layout.virtual[:3]) <= 0.2  # rubber soles: a touch-down is over in few samples
    assert max(rmse[joint] for joint in layout.virtual[3:]) <= 0.05
