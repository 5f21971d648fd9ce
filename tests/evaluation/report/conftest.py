"""Made-up trainings, and judged claims for the texts that name them."""

import csv
import json
from collections.abc import Callable, Iterable
from itertools import cycle
from pathlib import Path
from typing import Any

import pytest

from mobnet.core.columns import VERDICTS
from mobnet.settings.load import load_settings
from mobnet.settings.settings import Settings

GOLDEN = Path(__file__).parents[2] / "golden"
HEAD = "epoch,train_loss,validation_loss,validation_rmse,rate,gradient_norm"
NOTE: dict[str, Any] = {
    "target": "uncertainty", "settings": {"epochs": 3, "network": {"cell": "GRU", "Q": ["LL", "RL"]}},
    "parameters": 83712, "samples": 1800000, "diverged": False, "best": {"epoch": 99, "validation_loss": -99.0},
    "on_windows": {"loss": -1.0}, "device": "cpu", "precision": "float32",
    "fingerprint": "<script>alert(1)</script>", "provenance": {"commit": "c"},
}  # fmt: skip


@pytest.fixture(scope="session")
def settings() -> Settings:
    """The configuration at its default scale."""
    return load_settings(overrides={"scale": "default"})


@pytest.fixture(scope="session")
def write_run() -> Callable[..., Path]:
    """Write a made-up training: write_run(networks, name, lines of metrics.csv, **keys of run.json) -> its folder."""

    def write(networks: Path, name: str, lines: Iterable[str], **changed: Any) -> Path:
        method, limb, seed = name.rsplit("-", 2)
        named = {"name": name, "method": method, "limb": limb, "seed": int(seed[1:])}
        (networks / name).mkdir(parents=True, exist_ok=True)
        (networks / name / "run.json").write_text(json.dumps(named | NOTE | changed))
        (networks / name / "metrics.csv").write_text("\n".join([HEAD, *lines, ""]))
        return networks / name

    return write


@pytest.fixture
def claims_csv(tmp_path: Path, settings: Settings) -> Path:
    """Every claim of the configuration with a made-up number and each verdict in turn."""
    with (GOLDEN / "claims.csv").open() as golden, (tmp_path / "claims.csv").open("w") as file:
        writer = csv.DictWriter(file, next(csv.reader(golden)), extrasaction="ignore")
        writer.writeheader()
        for (name, claim), verdict in zip(settings.claims.items(), cycle(VERDICTS), strict=False):
            made = {"value": 1.0, "low": 0.9, "high": 1.1, "seed_count": 6, "differs": "yes", "rule": "> 0"}
            writer.writerow({**vars(claim), **made, "claim": name, "verdict": verdict})
    return tmp_path / "claims.csv"
