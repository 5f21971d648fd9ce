"""Error over the random torque of the training data: places in the order of their torque, the last panel its share."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table, write_rows

from mobnet.core.columns import Score
from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.further.amplitude import amplitude
from mobnet.evaluation.number.files import read_rows
from mobnet.settings.evaluation import Evaluation

AMPLITUDES = {"MOB-Net-strong": 100.0, "MOB-Net-plain": 0.0, "MOB-Net": 50.0}
ERRORS = {0.0: 4.0, 50.0: 2.0, 100.0: 2.5}


@pytest.fixture
def scores(write_limb_scores: Callable[..., Path]) -> list[Path]:
    """Scores of both tests; those of the collisions are of windows around pushes, and twice as large."""
    means = {method: ERRORS[torque] for method, torque in AMPLITUDES.items()}
    walked, hit = (write_limb_scores(name, means) for name in ("walk_test", "knee_swing"))
    rows = [
        Score(**{**vars(row), "metric": "rmse_pushed", "value": 2 * row.value})
        for row in read_rows(hit, Score)
        if row.metric == "rmse"
    ]
    write_rows(hit, rows)
    return [walked, hit]


def test_it_shows_errors_and_shares_in_the_order_of_the_torque(
    tmp_path: Path, evaluation: Evaluation, layout: JointLayout, scores: list[Path], explored: Path
) -> None:
    training = {method: [explored, explored] for method in AMPLITUDES}
    section = evaluation.amplitude
    amplitude(section, layout, evaluation.statistics, scores, AMPLITUDES, training, tmp_path / "out")
    check_golden(tmp_path / "out/amplitude.csv")
    rows = read_table(tmp_path / "out/amplitude.csv")
    panels = [[row for row in rows if row.panel == title] for title in dict.fromkeys(row.panel for row in rows)]
    for panel, factor in zip(panels, (1.0, 2.0), strict=False):
        assert [(row.amplitude_nm, row.value) for row in panel] == [
            (torque, pytest.approx(factor * error)) for torque, error in ERRORS.items()
        ]
    shares = panels[2]
    assert [row.amplitude_nm for row in shares] == [50.0, 100.0]  # without a torque nothing can be left
    for row in shares:
        assert row.value == pytest.approx(0.753, abs=0.03)  # 0.25 + 0.75 exp(-0.4), as the recording answers
    assert (tmp_path / "out/amplitude.png").read_bytes().startswith(b"\x89PNG")


def test_recordings_with_too_few_steps_have_no_share(
    tmp_path: Path,
    evaluation: Evaluation,
    layout: JointLayout,
    scores: list[Path],
    data_sets: dict[str, list[Path]],
) -> None:
    training = dict.fromkeys(AMPLITUDES, data_sets["walk"])
    section = evaluation.amplitude
    amplitude(section, layout, evaluation.statistics, scores, AMPLITUDES, training, tmp_path / "out")
    shares = [row for row in read_table(tmp_path / "out/amplitude.csv") if row.metric == "share"]
    assert [row.value for row in shares] == [None] * 2
