"""Made-up trainings, and judged claims for the texts that name them."""

import csv
from itertools import cycle
from pathlib import Path

import pytest
from made_pages import settings, write_run

from experiments.evaluation.tables.further.claims_summary import claims_summary
from experiments.settings.settings import Settings
from experiments.settings.verdicts import NOT_PRINTED, VERDICTS

__all__ = ["settings", "write_run"]

GOLDEN = Path(__file__).parents[3] / "golden"


@pytest.fixture
def claims_csv(tmp_path: Path, settings: Settings) -> Path:
    """Every claim of the configuration with a made-up number and each verdict in turn."""
    with (GOLDEN / "claims.csv").open() as golden, (tmp_path / "claims.csv").open("w") as file:
        writer = csv.DictWriter(file, next(csv.reader(golden)), extrasaction="ignore")
        writer.writeheader()
        for (name, claim), verdict in zip(settings.claims.items(), cycle(VERDICTS), strict=False):
            made = {
                "value": 1.0,
                "low": 0.9,
                "high": 1.1,
                "networks": 3,
                "walks": 2,
                "score": "ours" if claim.printed == NOT_PRINTED else "networks",
            }
            writer.writerow({**vars(claim), **made, "claim": name, "statement": name, "verdict": verdict})
    return tmp_path / "claims.csv"


@pytest.fixture
def summary_csv(tmp_path: Path, claims_csv: Path) -> Path:
    """How many of those claims have each verdict."""
    claims_summary(claims_csv, tmp_path)
    return tmp_path / "claims_summary.csv"
