"""Fine-tuning: each line at each number of seconds, between the network before and one of the robot's own walks."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table, write_rows

from experiments.evaluation.figures.further.fine_tuning import BEFORE, KNOWN, fine_tuning
from experiments.records.scores import Score
from experiments.settings.evaluation import Evaluation
from mobnet.core.rows import read_rows

SECONDS = (10, 60)
TUNED = {
    "MOB-Net-other-data-s-10": 4.5, "MOB-Net-other-data-s-60": 3.8, "MOB-Net-other-swing-data-s-10": 5.0,
    "MOB-Net-other-swing-data-s-60": 4.8,
}  # fmt: skip


def test_it_shows_every_line_of_a_changed_robot_at_every_number_of_seconds(
    tmp_path: Path, evaluation: Evaluation, write_limb_scores: Callable[..., Path]
) -> None:
    path, rows = tmp_path / "changed_walk.csv", []
    for level, means in (("robots_other", {"MOB-Net": 5.4, **TUNED}), ("robots", {"MOB-Net": 3.0})):
        made = read_rows(write_limb_scores("changed_walk", means), Score)
        rows += [Score(**{**vars(row), "level": level}) for row in made]
    write_rows(path, rows)
    title, test = next(iter(evaluation.fine_tuning.tests.items()))
    section = evaluation.fine_tuning.model_copy(update={"tests": {title: test}})
    fine_tuning(section, SECONDS, evaluation.statistics, [path], tmp_path / "out")
    check_golden(tmp_path / "out/fine_tuning.csv")
    shown = {(row.line, row.seconds): row.value for row in read_table(tmp_path / "out/fine_tuning.csv")}
    expected = {(BEFORE, 10): 5.4, (BEFORE, 60): 5.4, (KNOWN, 10): 3.0, (KNOWN, 60): 3.0}
    expected |= {("fine-tuned on labels", 10): 4.5, ("fine-tuned on labels", 60): 3.8}
    expected |= {("fine-tuned on free swings", 10): 5.0, ("fine-tuned on free swings", 60): 4.8}
    assert shown == {place: pytest.approx(value) for place, value in expected.items()}
    assert (tmp_path / "out/fine_tuning.png").read_bytes().startswith(b"\x89PNG")
