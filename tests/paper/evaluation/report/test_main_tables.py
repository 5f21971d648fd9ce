"""The tables of the main text repeat the numbers of other tables, and compare them with estimating nothing."""

import csv
from pathlib import Path

import pytest

from experiments.evaluation.number.number import shown_name
from experiments.evaluation.report.main_tables import main_tables
from experiments.plan.products import MAIN_TABLES, sources
from experiments.settings.settings import Settings

PUBLISHED = Path(__file__).parents[4] / "docs/results"


@pytest.fixture(scope="module")
def made(settings: Settings, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the three tables, from the published ones; one walk in ten of FTS-e2e ends without a rise."""
    folder = tmp_path_factory.mktemp("tables")
    used = {name: PUBLISHED / f"{name}.csv" for name in sources(settings.evaluation)}
    peaks = used["peaks"].read_text().splitlines()
    at = "hip_pitch_step,all_uncertainty,FTS-e2e,LL,avg,rise_"
    (delay,) = [line for line in peaks if line.startswith(f"{at}delay,")]
    bound = [f"{at}bound", "0.1", *delay.split(",")[7:-1], "-"]
    used["peaks"] = tmp_path_factory.mktemp("sources") / "peaks.csv"
    used["peaks"].write_text("\n".join([*peaks, ",".join(bound)]) + "\n")
    main_tables(settings.evaluation.main_tables, list(used.values()), folder / "legs.csv")
    return folder


def rows(path: Path, **wanted: str) -> list[dict[str, str]]:
    """Return the rows of a table with these fields."""
    return [row for row in csv.DictReader(path.read_text().splitlines()) if wanted.items() <= row.items()]


def cells(path: Path, first: str) -> list[str]:
    """Return the cells of the first line of a Markdown table that begins so."""
    return next(line for line in path.read_text().splitlines() if line.startswith(f"| {first} |"))[2:-2].split(" | ")


def test_each_is_written_in_three_forms(made: Path) -> None:
    assert sorted(path.name for path in made.iterdir()) == sorted(
        f"{name}.{ending}" for name in MAIN_TABLES for ending in ("csv", "tex", "md")
    )


def test_the_legs_are_those_of_their_tables(made: Path, settings: Settings) -> None:
    asked = {"method": "MOB-Net", "level": "robots", "scenario": "walk_test"}
    (walk,) = rows(PUBLISHED / "table_07.csv", joint="avg", metric="rmse", **asked)
    (own,) = rows(made / "legs.csv", row="MOB-Net", quantity="walk_test@robots@rmse")
    assert (own["value"], own["low"], own["high"], own["published"]) == tuple(
        walk[name] for name in ("value", "low", "high", "published")
    )
    asked |= {"scenario": "knee_swing", "joint": "avg", "metric": "push_share"}
    (push,) = rows(PUBLISHED / "peaks.csv", **asked)
    assert rows(made / "legs.csv", row="MOB-Net", quantity="knee_swing@robots@push_share")[0]["value"] == push["value"]
    methods = settings.evaluation.main_tables.legs.methods
    assert [cells(made / "legs.md", shown_name(method))[0] for method in methods] == list(map(shown_name, methods))


def test_a_delay_is_a_bound_where_one_ends_with_the_window(made: Path) -> None:
    (delay,) = rows(made / "legs.csv", row="FTS-e2e", quantity="hip_pitch_step@all_uncertainty@rise_delay")
    assert cells(made / "legs.md", "FTS-e2e")[5] == f">{float(delay['value']):.0f}"
    assert not any(cell.startswith(">") for cell in cells(made / "legs.md", "MOB-Net-gray"))


def test_halves_of_a_table_have_titles_and_a_gap(made: Path) -> None:
    columns, _, titles, rules, heads = (made / "legs.tex").read_text().splitlines()[:5]
    assert columns == r"\begin{tabular}{l@{\hspace{1.5em}}rrrrr@{\hspace{1.5em}}rrrrr}"
    known = r"\multicolumn{5}{c}{plant with the original's friction law}"
    unknown = r"\multicolumn{5}{c}{surrogate robots}"
    assert titles == rf" & {known} & {unknown} \\"
    assert rules == r"\cmidrule(lr){2-6}\cmidrule(lr){7-11}"
    assert heads.count(" & ") == 10


def test_a_limb_s_error_is_divided_by_that_of_zero_and_marked_above_it(made: Path) -> None:
    values = {
        method: float(rows(PUBLISHED / "methods.csv", scenario="hand_load_10", method=method, limb="LA", joint="avg",
                           metric="rmse_pushed")[0]["value"])
        for method in ("zero", "MOB-Net")
    }  # fmt: skip
    (row,) = rows(made / "limbs.csv", row="10 N in the hand (plant), arm", quantity="MOB-Net")
    assert float(row["value"]) == pytest.approx(values["MOB-Net"] / values["zero"], rel=1e-5)
    lines = (made / "limbs.md").read_text().splitlines()[2:]
    shares = [cell for line in lines for cell in line[2:-2].split(" | ")[3:] if cell != "-"]
    assert {cell.endswith("*") for cell in shares} == {True, False}
    assert all(float(cell.rstrip("*")) >= 1 for cell in shares if cell.endswith("*"))
    assert all(float(cell) <= 1 for cell in shares if not cell.endswith("*"))


def test_detectors_have_both_rules_of_thresholds(made: Path) -> None:
    found = rows(PUBLISHED / "found_by_rate.csv", detector="MOB", kind="collision", quantity="found")[0]["value"]
    (row,) = rows(made / "detectors.csv", row="MOB", quantity="found at rate")
    assert row["value"] == found
    assert cells(made / "detectors.md", "MOB-Net-sigma")[1] == "-"  # a standard deviation has no threshold of a mean
    placed = rows(PUBLISHED / "table_09.csv", detector="MOB", kind="largest", cell="all", quantity="found")[0]["value"]
    assert rows(made / "detectors.csv", row="MOB", quantity="found in place")[0]["value"] == placed
