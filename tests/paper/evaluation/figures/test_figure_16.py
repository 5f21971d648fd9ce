"""Figure 16: the force of one walk of each case over time from its contact on, and means beside the paper's."""

from dataclasses import replace

import pytest
from made_trials import EARLY, FORCE_N, HIT, write_made_course, write_trials
from paper_settings import settings_at

from experiments.evaluation.figures.paper.figure_16 import figure_16, force_of
from mobnet.core.rows import read_texts

SETTINGS = settings_at()
SECTION = SETTINGS.evaluation.figure_16


def made(folder, layout, rows, reacted_s):
    reactions = write_trials(folder, rows)
    courses = {case: write_made_course(folder / case, layout, reacted_s) for case in SECTION.cases}
    published, statistics = SETTINGS.published.section_5_4, SETTINGS.evaluation.statistics
    figure_16(SECTION, SETTINGS.reaction, statistics, published, reactions, courses, folder)
    return read_texts(folder / "figure_16.csv")


def knees(row):
    return type(row)(**{**vars(row), "case": "knee"})


def test_forces_begin_with_the_contact_and_means_have_the_paper_s(tmp_path, layout):
    rows = made(tmp_path, layout, [HIT, HIT, knees(HIT), knees(HIT)], reacted_s=0.52)
    foot = [row for row in rows if (row["case"], row["quantity"]) == ("foot", "force")]
    assert float(foot[0]["time_s"]) == pytest.approx(SECTION.shown_s[0])
    pushed = [float(row["time_s"]) for row in foot if float(row["value"]) == FORCE_N]
    assert pushed == [pytest.approx(0.002 * k) for k in range(50)]
    (peak,) = [row for row in rows if (row["case"], row["quantity"]) == ("knee", "first_peak")]
    assert (float(peak["value"]), float(peak["published"])) == (200.0, 298.3)
    assert (tmp_path / "figure_16.png").read_bytes().startswith(b"\x89PNG")


def test_a_reaction_stands_on_the_axis_of_its_force(tmp_path, layout):
    times, force, marks = force_of(write_made_course(tmp_path / "foot", layout, 0.52), SECTION)
    assert (len(times), force.max(), marks["reacted"]) == (len(force), FORCE_N, pytest.approx(0.02))


def test_falls_stand_over_the_time_that_a_reaction_waits(tmp_path, layout):
    late = replace(HIT, wait_s=0.2, reacted_s=4.21, fell_s=6.0)
    rows = made(tmp_path, layout, [HIT, late, replace(late, seed=241, fell_s=None), knees(HIT)], reacted_s=0.52)
    falls = {
        float(row["time_s"]): float(row["value"]) for row in rows if (row["case"], row["quantity"]) == ("foot", "falls")
    }
    assert falls == {0.0: 0.0, 0.2: 0.5}


def test_walks_that_touched_nothing_are_drawn_too(tmp_path, layout):
    rows = made(tmp_path, layout, [EARLY, knees(EARLY)], reacted_s=None)
    assert [row["value"] for row in rows if row["quantity"] == "impulse"] == [""] * 4


def test_contacts_that_begin_in_mid_swing_have_means_of_their_own(tmp_path, layout):
    stance = replace(HIT, seed=241, in_swing=0, impulse_ns=99.0)
    rows = made(tmp_path, layout, [HIT, stance, knees(stance)], reacted_s=0.52)
    impulses = {row["case"]: row["value"] for row in rows if row["quantity"] == "impulse"}
    assert impulses == {"foot": "54", "foot, in swing": "9", "knee": "99", "knee, in swing": ""}
