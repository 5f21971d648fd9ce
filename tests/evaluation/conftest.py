"""Small made-up runs: scores with a known mean, and files of a walk whose steps and errors are known."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from mobnet.core.joints import JointLayout, layout_of
from mobnet.core.recording import Recording, Sensed, Truth
from mobnet.core.store import write_array, write_recording
from mobnet.evaluation.rows import Score, write_rows

REPO = Path(__file__).parents[2]
RATE_HZ = 100.0
STEP_ROWS = 70  # rows in the air and rows on the ground of the made-up walk
JOINTS = [f"LL{i}" for i in range(1, 7)]
LEVELS = {"ideal": ["MOB"], "sensor_noise": ["MOB"], "all_uncertainty": ["MOB", "MOB-Net", "FTS-e2e"]}
MEANS = {"ideal": 0.01, "sensor_noise": 1.2, "MOB": 19.0, "MOB-Net": 1.5, "FTS-e2e": 2.0}  # avg [N m]


@pytest.fixture
def rng() -> np.random.Generator:
    """Random numbers, the same in every run."""
    return np.random.default_rng(5)


@pytest.fixture
def layout() -> JointLayout:
    """Joints of the robot."""
    table = yaml.safe_load((REPO / "configs/robots/tocabi.yaml").read_text())
    return layout_of(table["order"], table["groups"])


@pytest.fixture
def config() -> dict[str, Any]:
    """The part of a resolved configuration that evaluation reads; few draws, since only the plumbing counts here."""
    return {
        "scale": "default",
        "seed": 2023,
        "robot": str(REPO / "configs/robots/tocabi.yaml"),
        "published": str(REPO / "configs/published.yaml"),
        "rates": {"data_hz": 1000},
        "evaluation": {
            "confidence": 0.95,
            "bootstrap_draws": 200,
            "table_05": {"scenario": "forward_walk", "limb": "LL", "levels": LEVELS},
            "figure_05": {"scenario": "forward_walk", "joint": "LL3", "start_s": 1.0},
        },
        "sizes": {
            "train": {"shards": 6, "shard_s": 300.0},
            "test": {"shards": 3, "shard_s": 60.0},
            "network_seeds": [0, 1, 2],
            "epochs": 20,
        },
    }


def made_up_scores(networks: int = 2, tests: int = 3) -> list[Score]:
    """Return scores of every level and method whose means over runs are MEANS, joint by joint up to a factor."""
    rows = []
    for level, method in ((level, method) for level, methods in LEVELS.items() for method in methods):
        mean = MEANS.get(level, MEANS[method])
        seeds = range(networks if method != "MOB" else 1)
        for network, test in itertools.product(seeds, range(1, tests + 1)):
            off = 1 + 0.1 * (test - (tests + 1) / 2) + 0.04 * (network - (len(seeds) - 1) / 2)
            for i, joint in enumerate([*JOINTS, "avg"]):
                factor = 1.0 if joint == "avg" else (i + 1) / 3.5
                run = ("forward_walk", level, method, network, test, "LL", joint)
                rows.append(Score(*run, "rmse", mean * factor * off, "N m"))
                rows.append(Score(*run, "roughness", 50.0 * mean**0.1 * off, "N m/s"))
    return rows


@pytest.fixture
def make_scores() -> Callable[..., list[Score]]:
    """Make scores of any number of networks and tests: make_scores(networks=2, tests=3)."""
    return made_up_scores


@pytest.fixture
def scores_csv(tmp_path: Path) -> Path:
    """Scores of 2 networks on 3 tests, written."""
    write_rows(tmp_path / "scores.csv", Score, made_up_scores())
    return tmp_path / "scores.csv"


def write_walk(
    folder: Path, layout: JointLayout, error: float, steps: int = 4, method: str = "MOB-Net"
) -> dict[str, Any]:
    """Write recording, residual and estimate of a made-up walk and return its entry; LL only in the estimate.

    Args:
        folder: gets the files.
        layout: joints.
        error: constant error of the estimate of every joint [N m].
        steps: gait cycles.
        method: name in the entry.
    """
    rows = 2 * STEP_ROWS * steps
    phase = np.arange(rows) % (2 * STEP_ROWS)
    air = (phase < STEP_ROWS).astype(float)
    load = np.where(air > 0, 0.0, 60.0 * np.sin(np.pi * (phase - STEP_ROWS) / STEP_ROWS))
    truth = load[:, None] * np.linspace(-1, 1, layout.nv)
    zeros = np.zeros
    sensed = Sensed(zeros((rows, layout.nq)), zeros((rows, layout.nv)), zeros((rows, 3)), zeros((rows, layout.nu)),
                    zeros((rows, layout.nu)), np.stack([air, 1 - air], axis=1), zeros((rows, 5)))  # fmt: skip
    wrench = zeros((rows, 6))
    recording = Recording(sensed, ((0, rows),), RATE_HZ, {}, Truth(truth, wrench, wrench, zeros((rows, 2))))
    write_recording(folder / "recording", recording, layout)
    lp = [(f"tau_ext_lp.{joint}", layout.unit(joint), "joint") for joint in layout.names]
    r = [(f"r.{joint}", layout.unit(joint), "joint") for joint in layout.names]
    write_array(folder / "residual", np.concatenate([truth + 5, truth], axis=1), r + lp, {"rate_hz": RATE_HZ})
    where = layout.columns(JOINTS)
    columns = [(f"tau_ext.{joint}", "N m", "joint") for joint in JOINTS]
    write_array(folder / "estimate", truth[:, where] + error, columns, {"rate_hz": RATE_HZ})
    stems = {name: folder / name for name in ("recording", "residual", "estimate")}
    return {"level": "all_uncertainty", "method": method, "network_seed": 0, "test_seed": 1, **stems}


@pytest.fixture
def walk(tmp_path: Path, layout: JointLayout) -> Callable[..., dict[str, Any]]:
    """Write a made-up walk below the test's folder: walk(error, steps=4, method="MOB-Net") -> entry."""

    def write(error: float, steps: int = 4, method: str = "MOB-Net") -> dict[str, Any]:
        return write_walk(tmp_path / f"{method}-{error}-{steps}", layout, error, steps, method)

    return write
