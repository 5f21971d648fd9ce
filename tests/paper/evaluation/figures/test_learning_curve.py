"""The learning curve shows the table of trials that is kept."""

from dataclasses import astuple
from pathlib import Path

from csv_files import read_table

from experiments.evaluation.figures.further.learning_curve import beside_of, curves_of, draw_learning, learning_curve
from experiments.evaluation.number.rows import write_csv
from experiments.records.trial_errors import TRIALS, TrialError
from experiments.settings.figures import LearningCurve

SETTINGS = LearningCurve(
    data="lengths.csv",
    titles={"plant_leg": "left leg"},
    recipes={"adam": "Adam"},
    beside={"zero": "no estimate"},
)


def row(steps: int, error: float, seed: int = 0, state: str = "", joint: str = "avg") -> TrialError:
    changes = "plant_leg", "LSTM", f"experiment {steps}", "adam"
    return TrialError(*changes, seed, steps, 2e-6 * steps, state, -3.0, joint, error, 0.1, 6, 1)


def test_it_shows_the_mean_over_joints_of_trainings_that_did_not_diverge(tmp_path: Path) -> None:
    rows = [row(10, 2.0), row(3, 4.0), row(3, 9.0, joint="LL1"), row(39, 99.0, state="diverged")]
    write_csv(tmp_path / "lengths.csv", TRIALS, [astuple(one) for one in rows])
    settings = SETTINGS.model_copy(update={"data": str(tmp_path / "lengths.csv")})
    learning_curve(settings, tmp_path / "lengths.csv", tmp_path)
    shown = read_table(tmp_path / "learning_curve.csv")
    assert [(one.steps, one.rmse_nm) for one in shown] == [(10, 2.0), (3, 4.0)]
    assert (tmp_path / "learning_curve.png").read_bytes().startswith(b"\x89PNG")


def bare(error: float, method: str = "zero") -> TrialError:
    """Return the error of a method that does not learn."""
    return TrialError("plant_leg", method, "", "", 0, None, None, "", None, "avg", error, 0.1, 6, 0)


def test_trainings_of_a_length_are_together_the_shortest_first() -> None:
    rows = [row(3_000_000, 2.0), row(3_000_000, 4.0, seed=1), row(1_000_000, 5.0)]
    assert curves_of(SETTINGS, rows) == {"LSTM, Adam": {1_000_000: rows[2:], 3_000_000: rows[:2]}}
    assert curves_of(SETTINGS, [bare(33.8)]) == {}


def test_every_training_is_a_mark_and_lines_go_through_the_means() -> None:
    rows = [row(3_000_000, 2.0), row(3_000_000, 4.0, seed=1), row(1_000_000, 5.0), bare(6.0)]
    (axis,) = draw_learning(SETTINGS, {"plant_leg": rows}).axes
    assert (axis.get_xscale(), axis.get_yscale()) == ("log", "log")
    shorter, longer, means, across = (line.get_xydata().tolist() for line in axis.lines)
    assert (shorter, longer) == ([[2.0, 5.0]], [[6.0, 2.0], [6.0, 4.0]])
    assert means == [[2.0, 5.0], [6.0, 3.0]]
    assert {y for _, y in across} == {6.0}
    assert {text.get_text() for text in axis.texts} >= {"1 M", "3 M", "no estimate: 6.00 N m"}
    for (low, high), values in ((axis.get_xlim(), (2.0, 6.0)), (axis.get_ylim(), (2.0, 6.0))):
        assert low < values[0] < values[1] < high


def test_methods_that_do_not_learn_are_lines_unless_far_above_or_where_nothing_pushes() -> None:
    near, far = bare(5.9), bare(6.1)
    assert beside_of(SETTINGS, [near, row(3, 2.0)]) == ([near], [])
    assert beside_of(SETTINGS, [far, row(3, 2.0)]) == ([], [far])
    assert beside_of(SETTINGS, [bare(0.0), bare(1.0, "MOB"), row(3, 2.0)]) == ([], [])
