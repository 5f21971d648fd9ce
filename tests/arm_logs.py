"""Logs of a two-link arm, which moves on sines under the torques of its model and of friction, read with noise."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mobnet.robot.dynamics import inverse_dynamics
from mobnet.robot.nominal import NominalModel

RATE_HZ, SECONDS, WAVES = 1000.0, 12.0, 3
COULOMB_NM, VISCOUS, STEADY = 0.4, 0.3, 0.05  # friction: dry [N m], per speed [N m s/rad], and where it turns [rad/s]
NOISE = {"q": 1e-4, "v": 5e-3, "tau_motor": 0.05}
JOINTS = ("J1", "J2")


@pytest.fixture(scope="session")
def arm_log(arm):
    """Return a function of a seed that makes a log of the arm, a table with `time` and columns as in a recording."""

    def make(seed=0, seconds=SECONDS):
        rng, t = np.random.default_rng(seed), np.arange(0, seconds, 1 / RATE_HZ)
        rate = 2 * np.pi * rng.uniform(0.2, 1.2, (WAVES, 1, 2))
        size, angle = rng.uniform(0.15, 0.4, (WAVES, 1, 2)), rate * t[:, None] + rng.uniform(0, 6, (WAVES, 1, 2))
        q, v, a = (
            (size * part).sum(axis=0)
            for part in (np.sin(angle), rate * np.cos(angle), -np.square(rate) * np.sin(angle))
        )
        nominal = NominalModel(arm)
        tau = np.array([inverse_dynamics(nominal, *row) for row in zip(q, v, a, strict=True)])
        tau += COULOMB_NM * np.tanh(v / STEADY) + VISCOUS * v
        signals = {"q": q, "v": v, "tau_motor": tau}
        columns = {
            f"{name}.{joint}": values[:, k] + rng.normal(0, NOISE[name], len(t))
            for name, values in signals.items()
            for k, joint in enumerate(JOINTS)
        }
        return pd.DataFrame({"time": t, **columns})

    return make


@pytest.fixture(scope="session")
def clean(arm_log):
    return arm_log()


@pytest.fixture
def stored(tmp_path: Path):
    """Return a function that stores a table as CSV and returns its path."""

    def store(table):
        table.to_csv(tmp_path / "log.csv", index=False)
        return tmp_path / "log.csv"

    return store
