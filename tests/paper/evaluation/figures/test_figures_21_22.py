"""Figures 21 and 22 and the films: footsteps over time, pictures of walks into obstacles, frames that scroll."""

from dataclasses import replace

import numpy as np
import pytest
from made_trials import FORCE_N, HIT, write_made_course, write_trials
from paper_settings import settings_at
from PIL import Image

from experiments.evaluation.figures.drawing.robot import draw_scene, projection, solid_of
from experiments.evaluation.figures.drawing.solids import outline_of
from experiments.evaluation.figures.further.films import films, read_curves
from experiments.evaluation.figures.paper import figure_22 as pictures
from experiments.evaluation.figures.paper.figure_21 import draw_strips, figure_21, sole_corners, stances_of
from experiments.evaluation.figures.paper.figure_22 import figure_22, moments_of
from experiments.records.course import read_course
from mobnet.core.rows import read_texts

SETTINGS = settings_at()
SHOWN = SETTINGS.robot, SETTINGS.obstacles
DRESSED = SETTINGS.robot, SETTINGS.robot.looks, SETTINGS.obstacles


@pytest.fixture
def course(tmp_path, layout):
    """A course in which the robot reacts 20 ms after the contact."""
    return write_made_course(tmp_path / "course", layout, 0.52)


def test_a_course_has_the_base_where_it_was_and_the_samples_of_its_times(course, layout):
    walk = read_course(course, layout)
    assert (walk.q.shape, walk.force.shape, walk.swing.shape) == ((1000, layout.nq), (1000, 3), (1000, 2))
    assert walk.q[0, :3] == pytest.approx([0.0, 0.0, 0.9])
    assert (walk.at("contact_s"), walk.at("reacted_s")) == (500, 520)


@pytest.mark.parametrize("name", list(SETTINGS.obstacles))
def test_surfaces_of_obstacles_are_as_large_as_their_parts(name):
    for part in SETTINGS.obstacles[name].parts:
        seen = [outline_of(solid_of(part, (1.0, 2.0, 3.0)), view) for view in (np.eye(3), projection(0.0, 0.0))]
        (x, y), (_, z) = (np.ptp(outline, axis=0) / 2 for outline in seen)  # from above, and from ahead
        spread = np.array([x, y, z])
        along = "xyz".index(part.axis)
        if part.type == "box":
            assert spread == pytest.approx(part.size)
        else:
            ends = part.size[0] if part.type == "capsule" else 0.0
            assert spread[along] == pytest.approx(part.size[1] + ends, rel=0.01)
            assert np.delete(spread, along) == pytest.approx([part.size[0]] * 2, rel=0.06)  # of a polygon


def test_figure_21_has_the_feet_at_the_start_and_where_they_land(tmp_path, course):
    figure_21(SETTINGS.evaluation.figure_21, *SHOWN, {"foot": course}, tmp_path)
    rows = read_texts(tmp_path / "figure_21.csv")
    assert [(row["foot"], row["reacting"]) for row in rows] == [("left", "0"), ("right", "0"), ("left", "1")]
    assert float(rows[2]["time_s"]) == pytest.approx(0.7)
    assert float(rows[0]["y_m"]) > 0.05 > -0.05 > float(rows[1]["y_m"])
    # the left foot is in the air from 0.3 to 0.7 s, the right one never
    assert [float(row["until_s"]) for row in rows] == pytest.approx([0.3, 0.999, 0.999])
    assert (tmp_path / "figure_21.png").read_bytes().startswith(b"\x89PNG")


def test_figure_21_has_a_strip_for_each_foot_and_the_obstacle_where_it_is_in_its_way(course, layout, robot):
    walk = read_course(course, layout)
    left, right = draw_strips(walk, list(stances_of(robot, walk)), SETTINGS.obstacles).axes
    soles = [[patch.get_bbox().bounds for patch in axis.patches] for axis in (left, right)]
    assert [(x, width) for x, _, width, _ in soles[0]] == [pytest.approx((0.0, 0.3)), pytest.approx((0.7, 0.299))]
    assert {round(height, 6) for _, _, _, height in soles[0]} == {round(2 * robot.sole.box_half[0], 6)}
    assert [text.get_text() for text in (*left.texts, *right.texts)] == ["1"]
    lines = [{line.get_label(): line for line in axis.lines} for axis in (left, right)]
    assert set(lines[1]) == {"pelvis", "first contact", "reaction"}
    assert set(lines[0]) - set(lines[1]) == {"front of the obstacle"}  # the block is ahead of the left foot alone
    assert np.asarray(lines[0]["front of the obstacle"].get_ydata())[0] == pytest.approx(0.6)
    assert np.asarray(lines[0]["reaction"].get_xdata())[0] == pytest.approx(0.52)


def test_figure_21_of_a_walk_without_a_reaction_marks_none(tmp_path, layout, robot):
    walk = read_course(write_made_course(tmp_path / "calm", layout, None), layout)
    left, _ = draw_strips(walk, list(stances_of(robot, walk)), SETTINGS.obstacles).axes
    assert "reaction" not in {line.get_label() for line in left.lines}
    assert not left.texts


def test_a_sole_seen_from_above_has_its_size(robot):
    assert np.ptp(sole_corners(robot), axis=0) / 2 == pytest.approx(robot.sole.box_half[:2])


def made_walks(folder, layout, fell_s):
    """Return trials and courses of robots, whose first walks of each case fall at a time or, for None, do not."""
    cases = SETTINGS.evaluation.figure_22.cases
    trials, courses = [], {}
    for k, at_s in enumerate(fell_s, start=1):
        level = f"robot_{k}"
        stem = write_made_course(folder / level, layout, 0.52, level)
        courses[level] = dict.fromkeys(cases, stem)
        trials += [replace(HIT, case=case, level=level, fell_s=at_s) for case in cases]
    return write_trials(folder / "trials", trials), courses


def test_figure_22_shows_a_walk_that_ends_well_and_one_that_falls_with_their_counts(tmp_path, layout, monkeypatch):
    drawn = []
    monkeypatch.setattr(pictures, "save_figure", lambda figure, stem, columns, rows: drawn.append((figure, list(rows))))
    section = SETTINGS.evaluation.figure_22
    figure_22(section, *DRESSED, SETTINGS.reaction, *made_walks(tmp_path, layout, (0.9, None, 0.8, None)), tmp_path)
    ((figure, rows),) = drawn
    titles = [title for axis in figure.axes if (title := axis.get_title(loc="left"))]
    assert titles == [
        "(a) cart: 2 of 4 walks end without a fall; this one is that of robot 2",
        "(b) cart: 2 of 4 walks end in a fall; this one is that of robot 1",
        "(c) door: 2 of 4 walks end without a fall; this one is that of robot 2",
        "(d) door: 2 of 4 walks end in a fall; this one is that of robot 1",
    ]
    said = [axis.texts[-1].get_text() for axis in figure.axes[:4]]
    assert said == [f"0.00 s, {FORCE_N:.0f} N", "0.50 s", "0.50 s", "0.50 s, end"]  # the walk ends 0.499 s after it
    assert {(row[0], *row[-2:]) for row in rows} == {
        (case, robot, fell) for case in section.cases for robot, fell in (("robot_2", 0), ("robot_1", 1))
    }


def test_figure_22_has_no_row_of_what_did_not_happen(tmp_path, layout):
    section = SETTINGS.evaluation.figure_22
    figure_22(section, *DRESSED, SETTINGS.reaction, *made_walks(tmp_path, layout, (None,)), tmp_path)
    rows = read_texts(tmp_path / "figure_22.csv")
    assert len(rows) == len(section.cases) * (len(section.moments_s) + 2)
    assert {row["fell"] for row in rows} == {"0"}
    assert float(rows[0]["force_x_n"]) == -FORCE_N
    assert float(rows[3]["time_s"]) == pytest.approx(0.499)
    assert (tmp_path / "figure_22.png").read_bytes().startswith(b"\x89PNG")


def test_moments_are_in_order_and_stay_in_the_walk(course, layout):
    section = SETTINGS.evaluation.figure_22.model_copy(update={"moments_s": (9.0, -9.0)})
    found = moments_of(read_course(course, layout), section)
    assert found == {"-9 s": 0, "largest force": 500, "9 s": 999, "end": 999}
    assert list(found.values()) == sorted(found.values())


def test_a_scene_has_an_arrow_where_something_touches(course, layout, robot):
    from matplotlib.figure import Figure

    walk, view, drawn = read_course(course, layout), np.eye(3), []
    for k in (0, 550):
        axis = Figure().subplots()
        draw_scene(axis, robot, SETTINGS.obstacles, walk, k, view)
        drawn.append(len(axis.texts))
    assert drawn == [0, 1]  # an arrow is an annotation


def test_curves_count_time_from_the_contact(course, layout):
    curves = read_curves(course, read_course(course, layout), "LL3")
    assert (curves.time_s[0], curves.time_s[500], curves.reacted_s) == pytest.approx((-0.5, 0.0, 0.02))
    assert curves.force.max() == FORCE_N


def test_a_film_has_a_frame_for_each_step_of_time_and_ends_with_the_walk(tmp_path, course):
    section = SETTINGS.evaluation.films.model_copy(update={"shown_s": (0.3, 9.0), "frames_hz": 10.0, "slower": 1.0})
    out = tmp_path / "foot.webp"
    films(section, *DRESSED, {"foot": course}, {"foot": out})
    with Image.open(out) as film:
        assert film.n_frames == 2  # at 0.3 and 0.4 s; the walk ends at 0.499 s
        first = np.asarray(film.convert("RGB"))
    assert first.std() > 10.0
