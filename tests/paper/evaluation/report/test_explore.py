"""The page of pushes without a browser: what it reads of recordings, its numbers, and how its data are packed."""

import base64
import gzip
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_scenes import GAIN_HZ, LEAD, RATE_HZ, ROWS, START, pushed_scene

from experiments.evaluation.figures.drawing.robot import lowest
from experiments.evaluation.measure.estimates.pushes import read_pushes
from experiments.evaluation.report.explore import PackedArray, as_stored, explore, joint_names, packed, page_of, role_of
from experiments.evaluation.report.explore_numbers import ALREADY, ASLEEP, NEVER, push_numbers
from experiments.evaluation.report.explore_scenes import read_scene
from experiments.plan.parts import PageScene
from experiments.plan.products import EXPLORE, TEMPLATES
from experiments.plan.runs import Run
from mobnet.core.columns import residual_columns, torque_columns
from mobnet.core.errors import DataError
from mobnet.core.recording import Recording
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.kernel.low_pass import low_pass

REPO = Path(__file__).parents[4]
PUSHES = ((2500, 2600), (5000, 5080))  # rows of the made-up recording


def numbers_of(shown, settings, joint="LL3", threshold_nm=20.0):
    found = push_numbers(shown, joint, threshold_nm, settings.detection, settings.evaluation.peaks, 0.3)
    return {row.method: row for row in found}


def test_numbers_of_a_push_are_those_that_were_made(robot, settings):
    """The truth shows all of the push and FTS-e2e 40 % of it; friction of 40 N m is an error of the observer's."""
    found = numbers_of(pushed_scene(robot).push, settings)
    assert found["truth"].share == pytest.approx(1.0)
    assert found["truth"].error == 0.0
    assert found["FTS-e2e"].share == pytest.approx(0.4)
    assert found["FTS-e2e"].late_ms is None
    assert found["truth"].late_ms == pytest.approx(1000.0 / GAIN_HZ, abs=3.0)
    assert found["MOB"].error == pytest.approx(20 * found["MOB-Net-pushed"].error, rel=1e-6)
    assert 30.0 < found["MOB"].quiet_nm < 45.0
    assert found["MOB"].false_alarms >= 2


def test_an_alarm_is_late_by_the_filters_never_comes_or_stood_before(robot, settings):
    shown = pushed_scene(robot).push
    found = numbers_of(shown, settings)
    assert found["truth"].false_alarms == 0
    assert 5.0 < found["truth"].alarm < 60.0
    assert numbers_of(shown, settings, threshold_nm=500.0)["MOB"].alarm == NEVER
    assert numbers_of(shown, settings, threshold_nm=1.0)["MOB"].alarm == ALREADY


def test_a_leg_on_the_ground_is_not_watched(robot, settings):
    shown = pushed_scene(robot).push
    still = replace(shown, flags={**shown.flags, "watched": np.zeros(ROWS, dtype=bool)})
    found = numbers_of(still, settings)["MOB"]
    assert (found.alarm, found.false_alarms, found.quiet_nm) == (ASLEEP, 0, None)


def test_a_threshold_at_the_quiet_one_has_no_false_alarm_and_one_below_has(robot, settings):
    shown = pushed_scene(robot).push
    quiet = numbers_of(shown, settings)["MOB"].quiet_nm
    assert numbers_of(shown, settings, threshold_nm=quiet * 1.001)["MOB"].false_alarms == 0
    assert numbers_of(shown, settings, threshold_nm=quiet * 0.999)["MOB"].false_alarms > 0


def unpacked(data: str, shapes: list[tuple[int, int]], steps: list[float]) -> list[np.ndarray]:
    """Return the arrays of a page, of which each has a shape and a step, in its own unit."""
    rest = gzip.decompress(base64.b64decode(data))
    arrays = []
    for (rows, columns), step in zip(shapes, steps, strict=True):
        size = rows * columns
        planes, rest = np.frombuffer(rest[: 2 * size], np.uint8).reshape(2, -1).astype(np.uint16), rest[2 * size :]
        sums = np.cumsum((planes[0] + 256 * planes[1]).reshape(columns, rows), axis=1, dtype=np.uint16)
        arrays.append(sums.view(np.int16).T * step)
    assert rest == b""
    return arrays


def test_packed_arrays_come_back(rng):
    """Differences may exceed 16 bits and wrap around; two arrays of any width stand one after the other."""
    arrays = [rng.uniform(-300, 300, (40, 3)), rng.normal(size=(7, 1))]
    steps = [0.01, 0.001]
    data = packed(PackedArray("x", step, array) for step, array in zip(steps, arrays, strict=True))
    for back, array, step in zip(unpacked(data, [(40, 3), (7, 1)], steps), arrays, steps, strict=True):
        np.testing.assert_allclose(back, array, atol=step / 2 + 1e-9)


def test_torques_in_a_page_are_those_of_which_it_gives_numbers(robot, settings):
    made = pushed_scene(robot).push
    stored = as_stored(made, settings.evaluation.explore.step_nm)
    text = page(robot, settings)
    told, data = (re.search(f'id="{name}">(.*?)</script>', text, re.DOTALL)[1] for name in ("told", "data"))
    (scene,) = json.loads(told)["scenes"]
    parts = scene["parts"]
    shapes = [(part["count"], part["width"]) for part in parts]
    arrays = dict(
        zip([part["name"] for part in parts], unpacked(data, shapes, [part["step"] for part in parts]), strict=True)
    )
    np.testing.assert_allclose(arrays["truth"], stored.truth, atol=1e-9)
    np.testing.assert_allclose(arrays["FTS-e2e"], stored.estimates["FTS-e2e"], atol=1e-9)
    left = arrays["MOB"] - arrays["MOB-Net-pushed"]
    np.testing.assert_allclose(left, stored.estimates["MOB-Net-pushed"], atol=1e-9)


def test_the_published_page_gives_the_error_that_the_demo_gives() -> None:
    """One push, one window, one number."""
    published = (REPO / "docs/results/explore.html").read_text()
    scene = published[published.index('<tbody data-scene="story">') :].split("</tbody>")[0]
    demo = dict(re.findall(r"^(MOB\S*) .*RMSE ([\d.]+) N m over", (REPO / "docs/demo.md").read_text(), re.MULTILINE))
    assert set(demo) == {"MOB", "MOB-fric-dahl", "MOB-Net-pushed"}
    for method, error in demo.items():
        (row,) = re.findall(rf'<tr data-method="{method}">.*?</tr>', scene, re.DOTALL)
        assert f">{error}</td>" in row


def test_what_does_not_fit_is_refused():
    with pytest.raises(DataError, match=r"truth: 400 is not accepted; accepted: up to 327\.67"):
        packed([PackedArray("truth", 0.01, np.full((2, 1), 400.0))])


def page(robot, settings, **scenes):
    evaluation = settings.evaluation
    alarm = {"detector": "MOB-Net-pushed-ratio", "at": START + 24, "named": "left knee, front"}
    shown = scenes or {"story": pushed_scene(robot)}
    return page_of(shown, alarm, evaluation.explore, evaluation.story, settings.detection, evaluation.peaks, robot,
                   REPO / TEMPLATES / "explore.html")  # fmt: skip


def test_page_needs_nothing_else_is_small_and_always_the_same(robot, settings):
    """A page of five scenes: nothing is loaded, below 3 MB."""
    scenes = {name: pushed_scene(robot, seed) for seed, name in enumerate(("story", "b", "c", "d", "e"))}
    once = page(robot, settings, **scenes)
    assert once == page(robot, settings, **scenes)
    assert len(once) < 3_000_000
    assert not re.search(r"https?:|@import|url\(|\ssrc=|<link", once)
    ids = re.findall(r'\sid="([^"]*)"', once)
    assert len(ids) == len(set(ids))


def test_page_without_scripts_says_so_and_has_the_numbers(robot, settings):
    text, found = page(robot, settings), numbers_of(pushed_scene(robot).push, settings)
    assert '<p id="still">' in text
    assert '<div class="live" hidden>' in text
    row = re.search(r'<tr data-method="MOB-Net-pushed">.*?</tr>', text, re.DOTALL)
    assert row
    assert f'<td data-label="peak [N m]">{found["MOB-Net-pushed"].peak:.1f}</td>' in row[0]


def test_a_variant_has_the_colour_of_its_method_and_the_fourth_step_tells_of_it(robot, settings):
    roles = {name: role_of(name) for name in ("MOB", "MOB-Net", "MOB-Net-pushed", "FTS-e2e-pushed", "MOB-fric-dahl")}
    assert list(roles.values()) == ["observer", "network", "network", "direct", "formula"]
    assert '<p data-step="4">MOB-Net-pushed subtracts' in page(robot, settings)


def test_joints_have_names_that_a_reader_knows(robot):
    names = joint_names(robot)
    assert (names["LL3"], names["RL4"], names["W1"]) == ("left hip pitch", "right knee", "waist 1")


@pytest.fixture(scope="module")
def recorded(tmp_path_factory, made_up, robot):
    """A recording of 8 s with two pushes on the left knee, its residual and the estimates of three methods, as runs."""
    folder, layout, recording = tmp_path_factory.mktemp("walk"), robot.layout, made_up(seed=3, seconds=8.0)
    rows = len(recording.sensed)
    pushed, row, torque = np.zeros((rows, 1)), np.zeros((rows, 4)), np.zeros((rows, layout.nv))
    for start, end in PUSHES:
        pushed[start:end], row[start:end] = 1.0, [2.0, -100.0, 0.0, 20.0]
        torque[start:end, layout.columns(["LL3"])] = 40.0
    truth = replace(recording.truth, pushed=pushed, push=row, tau_push=torque, tau_ext=recording.truth.tau_ext + torque)
    write_recording(
        folder / "recording", Recording(recording.sensed, recording.segments, RATE_HZ, recording.meta, truth), layout
    )
    external = low_pass(truth.tau_ext, GAIN_HZ, RATE_HZ)
    note = {"rate_hz": RATE_HZ, "gain_hz": GAIN_HZ}
    write_array(folder / "residual", np.concatenate([external + 9.0, external], axis=1), residual_columns(layout), note)
    runs = []
    for error, method in enumerate(("MOB", "MOB-fric-dahl", "MOB-Net-pushed")):
        joints = layout.limb("LL")
        array = external[:, layout.columns(joints)] + error
        columns = torque_columns(layout, ["tau_ext"], joints)
        if method == "MOB-Net-pushed":
            array, columns = (
                np.concatenate([array, np.full_like(array, 2.0)], axis=1),
                torque_columns(layout, ["tau_ext", "std"], joints),
            )
        write_array(folder / method, array, columns, {"rate_hz": RATE_HZ})
        runs.append(Run("knee", "robot_1", method, 0, 1, folder / "recording", folder / "residual", folder / method))
    return tuple(runs)


def scene_of(runs, settings, name=None, from_s=0.0):
    pushes = {push: settings.pushes[push] for push in ("collision_left_foot_front", "collision_left_knee_front")}
    return PageScene("Knee", "robot", runs, ("LL",), "LL3", 20.0, "MOB-Net-pushed", pushes, name, from_s)


def read(scene, settings, robot):
    evaluation = settings.evaluation
    return read_scene(scene, evaluation.explore, evaluation.story, settings.detection, robot)


def test_a_scene_is_the_recording_around_its_push(recorded, settings, robot):
    scene = read(scene_of(recorded, settings), settings, robot)
    assert scene.name == "collision_left_knee_front"
    shown = scene.push
    story = settings.evaluation.story
    before = round(story.before_s * RATE_HZ)
    assert (shown.start - shown.settled, shown.end - shown.start, shown.settled) == (before, 100, LEAD)
    assert len(shown.truth) == LEAD + before + round(story.after_s * RATE_HZ)
    assert shown.first + shown.start == PUSHES[0][0]
    np.testing.assert_allclose(shown.estimates["MOB-Net-pushed"] - shown.truth, 2.0, atol=1e-3)
    assert set(shown.stds) == {"MOB-Net-pushed"}
    assert np.abs(shown.push[: shown.start]).max() == 0.0
    assert shown.push[shown.end - 1, 2] == pytest.approx(40.0)


@pytest.mark.parametrize(
    ("name", "from_s", "start"),
    [
        ("collision_left_knee_front", 0.0, 2500),
        (None, 2.6, 5000),
        (None, 6.0, None),
        ("collision_left_foot_front", 0.0, None),
    ],
)
def test_a_scene_shows_the_first_push_of_its_name_from_its_time_on(recorded, settings, robot, name, from_s, start):
    shown = read(scene_of(recorded, settings, name, from_s), settings, robot)
    assert (shown.push.first + shown.push.start if shown else None) == start


def test_the_robot_stands_on_its_lower_sole(recorded, settings, robot):
    """Whatever a drifting base says."""
    shown = read(scene_of(recorded, settings), settings, robot)
    assert max(abs(lowest(robot, q)) for q in shown.poses[::40]) < 1e-6
    assert np.abs(shown.poses[0, :2]).max() == 0.0


def test_the_page_and_figure_6_have_the_same_samples(recorded, settings, robot):
    figure = settings.evaluation.figure_06.model_copy(update={"joint": "LL3"})
    moved = read(scene_of(recorded, settings), settings, robot).push
    panel = read_pushes(robot.layout, figure, recorded, "step {}")[0]
    rows, curves = (
        moved.start + np.round(panel.time * RATE_HZ).astype(int),
        {one.label: one.values for one in panel.curves},
    )
    np.testing.assert_array_equal(curves["truth"], moved.truth[rows, 2])
    for method, found in moved.estimates.items():
        np.testing.assert_array_equal(curves[method], found[rows, 2])


def test_without_any_push_there_is_no_page(recorded, settings, robot_table, tmp_path):
    evaluation = settings.evaluation
    scenes = {"b": scene_of(recorded, settings, from_s=6.0)}
    with pytest.raises(DataError, match="no recording has a push that the page shows"):
        explore(evaluation.explore, evaluation.story, settings.detection, evaluation.peaks, robot_table, None, scenes,
                tmp_path / "c.csv", tmp_path / "d.csv", [REPO / TEMPLATES / EXPLORE[0]],
                tmp_path / "explore.html")  # fmt: skip


def test_the_page_is_written_and_its_numbers_are_json(recorded, settings, robot_table, tmp_path):
    """Scenes without a push are left out."""
    evaluation, out = settings.evaluation, tmp_path / "explore.html"
    scenes = {"b": scene_of(recorded, settings), "c": scene_of(recorded, settings, from_s=6.0)}
    explore(evaluation.explore, evaluation.story, settings.detection, evaluation.peaks, robot_table,
            robot_table.looks, scenes, tmp_path / "c.csv", tmp_path / "d.csv",
            [REPO / TEMPLATES / name for name in EXPLORE], out)  # fmt: skip
    told = json.loads(re.search(r'id="told">(.*?)</script>', out.read_text(), re.DOTALL)[1])
    assert [scene["name"] for scene in told["scenes"]] == ["b"]
    assert told["scenes"][0]["flags"]["pushed"] == [[LEAD + 1700, LEAD + 1800]]
