"""The learning curve shows the table of trials that is kept."""

from dataclasses import astuple
from pathlib import Path

from csv_files import read_table

from experiments.evaluation.figures.further.learning_curve import AXES, beside, curves_of, learning_curve
from experiments.evaluation.number.rows import write_csv
from experiments.settings.figures import LearningCurve
from mobnet.core.columns import TRIALS, TrialError

SETTINGS = LearningCurve(
    data="lengths.csv",
    titles={"plant_leg": "left leg"},
    recipes={"adam": "Adam"},
    beside={"zero": "estimating nothing"},
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


def test_a_place_is_the_mean_of_its_networks() -> None:
    rows = [row(3_000_000, 2.0), row(3_000_000, 4.0, seed=1), row(1_000_000, 5.0)]
    (line,), (timed,) = (curves_of(SETTINGS, rows, place) for place in AXES.values())
    assert (line.label, line.x, timed.x) == ("LSTM, Adam", [1.0, 3.0], [2.0, 6.0])
    assert [number.value for number in line.numbers] == [5.0, 3.0]
    assert line.dots == [[5.0], [2.0, 4.0]]


def test_methods_that_do_not_learn_stand_in_the_panel_unless_nothing_pushes() -> None:
    def of(error: float) -> TrialError:
        return TrialError("plant_leg", "zero", "", "", 0, None, None, "", None, "avg", error, 0.1, 6, 0)

    assert beside(SETTINGS, [of(33.774), row(3, 2.0)]) == "estimating nothing: 33.77 N m"
    assert beside(SETTINGS, [of(0.0)]) == ""
    assert curves_of(SETTINGS, [of(33.774)], AXES["processor time [s]"]) == []
