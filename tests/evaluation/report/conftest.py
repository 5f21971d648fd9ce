"""Made-up trainings, and judged claims for the texts that name them."""

import csv
import json
from collections.abc import Callable, Iterable
from itertools import cycle
from pathlib import Path
from typing import Any

import pytest
from made_detections import on_both_plants
from made_notes import training_note

from experiments.evaluation.tables.further.claims_summary import claims_summary
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.columns import NOT_PRINTED, VERDICTS

GOLDEN = Path(__file__).parents[2] / "golden"
HEAD = "epoch,train_loss,validation_loss,validation_rmse,rate,gradient_norm,stride"


@pytest.fixture(scope="session")
def settings() -> Settings:
    """The configuration at its default scale; what tables are made from is made once, for other tests too."""
    return on_both_plants(load_settings(overrides={"scale": "default"}))


@pytest.fixture(scope="session")
def write_run() -> Callable[..., Path]:
    """Write a made-up training: write_run(networks, name, lines of metrics.csv, **keys of run.json) -> its folder."""

    def write(networks: Path, name: str, lines: Iterable[str], **changed: Any) -> Path:
        (networks / name).mkdir(parents=True, exist_ok=True)
        rows = list(lines)
        note = training_note(name, [float(row.split(",")[2]) for row in rows], **changed)
        (networks / name / "run.json").write_text(json.dumps(note))
        (networks / name / "metrics.csv").write_text("\n".join([HEAD, *(f"{row},1" for row in rows), ""]))
        return networks / name

    return write


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
