"""Numbers and orders in captions are those of the published results and trials that they tell of."""

import re
from pathlib import Path
from statistics import mean

import pytest
from csv_files import read_table

from experiments.evaluation.measure.learning.explained import ALL, PATH, by_robot, read_why
from experiments.evaluation.measure.learning.taught import SHARE_OF_HIT, WALKING
from experiments.evaluation.number.frames import rows_of
from experiments.settings.settings import Settings

ROOT = Path(__file__).parents[4]
CAPTIONS = ROOT / "workflow/report"
RESULTS, TRIALS = ROOT / "docs/results", ROOT / "docs/trials"
OLDER = (
    r"The published (?:table|figure) is of an older run.* their order is (.+), which is not the (?:paper|original)'s"
)


def words(caption: str) -> str:
    """Return the text of a caption in one line."""
    return " ".join((CAPTIONS / f"{caption}.rst").read_text(encoding="utf-8").split())


@pytest.mark.parametrize("caption", ["tables/kinds", "figures/figure_17"])
def test_captions_of_kinds_tell_of_the_older_recipes_as_long_as_results_are_of_them(
    caption: str, settings: Settings
) -> None:
    figure = settings.evaluation.figure_17
    rows = read_table(RESULTS / "kinds.csv")
    errors = {row.method: row.value for row in rows if row.quantity == "validation RMSE" and row.method in figure.best}
    older, told = not {*figure.methods} <= {row.method for row in rows}, re.search(OLDER, words(caption))
    assert (told is not None) == older, f"{caption}: its last sentence is of results without {figure.methods}"
    if told:
        assert told[1].split(", ") == sorted(errors, key=lambda kind: errors[kind])
        printed = {row.method: row.published for row in rows if row.quantity == "order"}
        ranked = [printed[kind] for kind in told[1].split(", ") if printed[kind]]
        assert ranked != sorted(ranked)


def test_the_learning_curve_says_that_its_robots_are_older() -> None:
    """Errors of methods that do not learn: on the walks of the trials, and in the table of random walking."""
    tried = {
        row.method: row.rmse_nm
        for row in read_table(TRIALS / "lengths.csv") if (row.task, row.joint) == ("robot_leg", "avg")
    }  # fmt: skip
    shown = {
        row.method: row.value
        for row in read_table(RESULTS / "table_07.csv") if (row.joint, row.metric) == ("avg", "rmse")
    }  # fmt: skip
    numbers = [f"{errors[method]:.1f}" for errors in (tried, shown) for method in ("MOB", "MOB-fric")]
    robot, today = "an error of {} N m and MOB-fric one of {} N m on it", "Table 7 has {} and {} N m"
    assert f"{robot}, where {today}".format(*numbers) in words("figures/learning_curve")


def test_the_error_falls_with_the_length_of_training_as_the_learning_curve_says() -> None:
    """The trials give no field, so that the sentence is tested: of each task and recipe, mean over networks."""
    errors: dict[tuple[str, ...], dict[int, list[float]]] = {}
    for row in read_table(TRIALS / "lengths.csv"):
        if row.joint == "avg" and row.recipe:
            lengths = errors.setdefault((row.task, row.method, row.recipe), {})
            lengths.setdefault(int(row.steps), []).append(row.rmse_nm)
    assert len(errors) > 1
    for lengths in errors.values():
        means = [mean(lengths[steps]) for steps in sorted(lengths)]
        assert means == sorted(means, reverse=True)
    assert words("figures/learning_curve").count("The error falls with the length of the training") == 1


def test_every_robot_shows_what_the_paper_says_of_why_a_hit_is_hidden() -> None:
    """Of the figures `why_share` and `hit_path`, whose numbers are those of a trial and no fields."""
    rows = read_why(TRIALS / "why.csv")
    seen, blind = (("why_walk", method, "soap") for method in ("MOB-Net", "MOB-Net-noimu"))
    for measure in (SHARE_OF_HIT, WALKING):
        values = by_robot(rows, measure)
        assert set(values[seen]) == set(values[blind])
        for robot, value in values[seen].items():
            assert values[blind][robot] > value
    brought = rows_of(rows, measure=PATH, method="MOB-Net")
    taken = dict(zip(zip(brought["robot"], brought["inputs"], strict=True), brought["value"], strict=True))
    robots = {robot for robot, _ in taken}
    assert len(robots - {ALL}) > 1
    for robot in robots:
        sensor = taken[robot, "inertial sensor"]
        assert taken[robot, "desired torque"] > sensor
        assert max(taken[robot, "positions"], taken[robot, "velocities"]) < sensor / 2
    text = " ".join((ROOT / "paper/main.tex").read_text(encoding="utf-8").split())
    assert "a network that does not see the inertial sensor shows more of a hit, for a larger error in walking." in text
    assert "the desired torque takes more of a hit into the prediction than the inertial sensor does, positions" in text
