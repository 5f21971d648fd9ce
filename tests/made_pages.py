"""The configuration of pages, and made-up trainings for them. A conftest imports the fixtures."""

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import pytest
from made_detections import on_both_plants
from made_notes import training_note
from paper_settings import settings_at

from experiments.settings.settings import Settings

HEAD = "epoch,train_loss,validation_loss,validation_rmse,rate,gradient_norm,stride"


@pytest.fixture(scope="session")
def settings() -> Settings:
    """The configuration at its default scale; what tables are made from is made once, for other tests too."""
    return on_both_plants(settings_at())


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
