"""The table of what a reaction is worth: who falls, how hard obstacles push, and reactions to nothing."""

from dataclasses import fields, replace

import pytest
from csv_files import check_golden
from made_trials import EARLY, HIT, LEANS, write_trials
from paper_settings import settings_at

from experiments.evaluation.measure.reaction.results import EARLY as IS_EARLY
from experiments.evaluation.measure.reaction.results import with_measures
from experiments.evaluation.number.frames import TRIALS, frame_of, read_trials
from experiments.evaluation.tables.further.safety import safety
from mobnet.core.errors import DataError
from mobnet.core.rows import read_texts

SETTINGS = settings_at()
ROWS = [
    HIT,
    replace(HIT, seed=241, first_peak_n=300.0, angle_deg=50.0, level="robot_2"),
    replace(EARLY, seed=242),
    LEANS,
    replace(LEANS, seed=241, fell_s=None),
    replace(HIT, case="knee", first_peak_n=400.0),
]


@pytest.fixture
def table(tmp_path):
    """A function of rows -> the rows of the table by case, detector and measure, and its text."""

    def make(rows):
        reactions = write_trials(tmp_path, rows)
        published, statistics = SETTINGS.published.section_5_4, SETTINGS.evaluation.statistics
        section = SETTINGS.evaluation.safety.model_copy(
            update={"cases": tuple(dict.fromkeys(row.case for row in rows))}
        )
        safety(section, SETTINGS.reaction, statistics, published, reactions, tmp_path)
        cells = {(row["case"], row["detector"], row["measure"]): row for row in read_texts(tmp_path / "safety.csv")}
        return cells, (tmp_path / "safety.md").read_text()

    return make


def test_falls_are_of_all_walks_and_forces_of_those_that_were_hit(table):
    cells, _ = table(ROWS)
    ours, none = ("foot", "MOB-Net-pushed-ratio"), ("foot", "none")
    assert (cells[*ours, "falls"]["value"], cells[*ours, "falls"]["walks"], cells[*ours, "falls"]["touched"]) == (
        "0", "3", "2",
    )  # fmt: skip
    assert cells[*none, "falls"]["value"] == "0.5"
    assert float(cells[*ours, "first_peak"]["value"]) == 250.0
    assert float(cells[*none, "impulse"]["value"]) == 300.0
    assert float(cells[*ours, "alarm"]["value"]) == pytest.approx(10.0)  # ms
    assert float(cells[*ours, "within"]["value"]) == 0.5  # of 10 and 50 degrees
    assert float(cells[*ours, "early"]["value"]) == pytest.approx(1 / 3, abs=1e-5)
    assert cells[*none, "early"]["value"] == ""  # who does not react reacts to nothing


def test_the_table_is_the_golden_one(table, tmp_path):
    table(ROWS)
    check_golden(tmp_path / "safety.csv")


def test_the_paper_s_numbers_stand_beside_force_and_impulse(table):
    cells, _ = table(ROWS)
    assert cells["foot", "MOB-Net-pushed-ratio", "first_peak"]["published"] == "197.7"
    assert cells["knee", "MOB-Net-pushed-ratio", "impulse"]["published"] == "19.5"
    assert cells["foot", "MOB-Net-pushed-ratio", "falls"]["published"] == ""


def test_a_case_is_named_once_and_has_a_line_for_each_detector(table):
    _, text = table(ROWS)
    lines = [line for line in text.splitlines() if line.startswith("| ")][2:]
    named = [line.split("|")[1].strip() for line in lines]
    assert named == ["foot", "", "foot, in swing", "knee", "knee, in swing"]
    assert "2 of 3" in lines[0]


def test_contacts_that_begin_in_mid_swing_have_a_row_of_their_own(table):
    stance = replace(HIT, seed=241, in_swing=0, impulse_ns=99.0)
    late = replace(HIT, seed=242, wait_s=0.2, impulse_ns=50.0)
    cells, _ = table([HIT, stance, late, replace(LEANS, seed=243)])
    every, swing = (
        cells["foot", "MOB-Net-pushed-ratio", "median_impulse"],
        cells["foot, in swing", "MOB-Net-pushed-ratio", "impulse"],
    )
    assert (swing["walks"], float(swing["value"]), swing["published"]) == ("1", HIT.impulse_ns, "7.7")
    assert (
        every["wait_s"] == "0.2"
    )  # the last row of this name; no late reaction, nor a robot without one, is in `swing`
    assert swing["wait_s"] == "0"


def test_a_case_in_front_of_no_leg_has_one_row(table):
    cells, _ = table([replace(HIT, case="door", in_swing=None)])
    assert {case for case, *_ in cells} == {"door"}


def test_nothing_that_happened_is_a_table_too(table):
    cells, _ = table([EARLY])
    assert cells["foot", "MOB-Net-pushed-ratio", "first_peak"]["value"] == ""


def test_lines_keep_the_order_of_the_files(table):
    cells, _ = table(ROWS)
    assert list(dict.fromkeys(key[:2] for key in cells)) == [
        ("foot", "MOB-Net-pushed-ratio"),
        ("foot", "none"),
        ("foot, in swing", "MOB-Net-pushed-ratio"),
        ("knee", "MOB-Net-pushed-ratio"),
        ("knee, in swing", "MOB-Net-pushed-ratio"),
    ]


def measures_of(*rows):
    return with_measures(frame_of(rows, TRIALS), SETTINGS.evaluation.safety)


def test_early_is_what_comes_before_the_contact_and_says_nothing_about_it():
    before = replace(HIT, reacted_s=3.9, alarm_s=3.9)
    measures = measures_of(HIT, EARLY, before)
    assert measures[IS_EARLY].tolist() == [False, True, True]
    assert measures["touched"].tolist() == [True, False, False]
    assert measures["first_peak"].notna().tolist() == [True, False, False]


def test_who_does_not_react_is_never_early_nor_late():
    measures = measures_of(LEANS)
    assert measures[IS_EARLY].isna().all()
    assert measures["noticed"].isna().all()


def test_a_schema_has_the_columns_of_its_file():
    assert list(TRIALS) == [field.name for field in fields(type(HIT))]


@pytest.mark.parametrize(("row", "text"), [
    (replace(HIT, peak_n=-1.0), "peak_n: -1.0 is not accepted"),
    (replace(HIT, alarm_s=4.5), "at most reacted_s"),
])  # fmt: skip
def test_damaged_files_are_refused(tmp_path, row, text):
    with pytest.raises(DataError, match=text):
        read_trials(write_trials(tmp_path, [row]), ["foot"])


def test_what_carries_a_robot_has_no_impulse_and_who_did_not_notice_is_counted(table):
    plate = replace(HIT, case="plate")
    unnoticed = replace(plate, seed=241, alarm_s=None, limb="", reacted_s=None, angle_deg=None, base_angle_deg=None)
    cells, _ = table([plate, unnoticed, HIT])
    ours = ("plate", "MOB-Net-pushed-ratio")
    for measure in ("impulse", "first_impulse", "median_impulse", "heavy"):
        assert cells[*ours, measure]["value"] == ""
        assert cells["foot", "MOB-Net-pushed-ratio", measure]["value"] != ""
    assert cells[*ours, "first_peak"]["value"] == "200"
    assert float(cells[*ours, "noticed"]["value"]) == 0.5
