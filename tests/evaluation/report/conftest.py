"""Judged claims, for the texts that name them."""

from __future__ import annotations

import csv
from itertools import cycle
from pathlib import Path

import pytest

from mobnet.evaluation.tables.claims import VERDICTS
from mobnet.settings.load import load_settings
from mobnet.settings.settings import Settings

GOLDEN = Path(__file__).parents[2] / "golden"


@pytest.fixture(scope="session")
def settings() -> Settings:
    """The configuration at its default scale."""
    return load_settings(overrides={"scale": "default"})


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
