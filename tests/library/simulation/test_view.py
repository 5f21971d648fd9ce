"""Walking for the eye: states at their times, and a viewer that shows the plant without touching it."""

import contextlib
import time

import mujoco
import mujoco.viewer
import numpy as np
import pytest

from mobnet.simulation import view

pytestmark = pytest.mark.sim


class FakeViewer:
    """Stands in for MuJoCo's: notes what it is given to show, and is closed after some looks."""

    def __init__(self, model, data, looks):
        self.model, self.data, self.looks = model, data, looks
        self.cam, self.shown, self.aims, self.locked = mujoco.MjvCamera(), [], [], False

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.closed = True

    @contextlib.contextmanager
    def lock(self):
        self.locked = True
        yield
        self.locked = False

    def is_running(self):
        self.looks -= 1
        return self.looks >= 0

    def sync(self):
        assert not self.locked
        self.shown.append((time.perf_counter(), self.data.qpos.copy()))
        self.aims.append(self.cam.lookat.copy())


@pytest.fixture
def open_viewer(monkeypatch):
    """A function (looks until it is closed) -> viewers opened."""
    opened = []

    def install(looks):
        def launch(model, data, **_):
            opened.append(FakeViewer(model, data, looks))
            return opened[-1]

        monkeypatch.setattr(mujoco.viewer, "launch_passive", launch)
        return opened

    return install


def test_walk_yields_the_start_and_then_every_time_asked_for(simulate):
    simulator, twin = simulate("flat_walk", "ideal"), simulate("flat_walk", "ideal")
    states = list(view.walk(simulator, 0.4, 0.1))
    assert len(states) == 5
    twin.run(np.zeros((200, twin.width), dtype=np.float32))
    np.testing.assert_array_equal(states[2], twin.world.data.qpos)


def test_walk_ends_with_a_fall(simulate):
    simulator = simulate("flat_walk", "ideal")
    simulator.world.data.qvel[1] = 6.0
    states = list(view.walk(simulator, 10.0, 0.1))
    assert 2 < len(states) < 40
    assert not view.upright(simulator)


def test_mid_stride_has_the_left_foot_in_the_air(simulate):
    simulator = simulate("flat_walk", "ideal")
    assert view.upright(simulator)
    view.walk_to_mid_stride(simulator)
    assert simulator.state.swinging == 1
    assert simulator.state.side < 0


def test_the_viewer_shows_the_walk_in_real_time_until_it_is_closed(simulate, open_viewer):
    """What a mouse can pull there is not the plant."""
    simulator, twin = simulate("checks_place", "ideal"), simulate("checks_place", "ideal")
    (viewer,) = watched(simulator, open_viewer(41), np.inf)
    assert viewer.data is not simulator.world.data
    assert viewer.model is not simulator.world.model
    assert len(viewer.shown) == 41
    times = [moment for moment, _ in viewer.shown]
    assert 0.38 < times[-1] - times[0] < 0.8
    for (_, shown), wanted in zip(viewer.shown, view.walk(twin, 0.4, view.SYNC_S), strict=True):
        np.testing.assert_array_equal(shown, wanted)


def test_the_viewers_camera_goes_with_the_robot(simulate, open_viewer):
    simulator = simulate("flat_walk", "ideal")
    (viewer,) = watched(simulator, open_viewer(20), np.inf)
    offsets = np.array(viewer.aims) - [shown[:3] for _, shown in viewer.shown]
    np.testing.assert_allclose(offsets, np.tile(offsets[0], (len(offsets), 1)), atol=1e-12)


def test_when_the_time_is_over_the_window_stays(simulate, open_viewer):
    simulator = simulate("checks_place", "ideal")
    (viewer,) = watched(simulator, open_viewer(30), 0.1)
    assert len(viewer.shown) == 11
    assert viewer.looks < 0


def watched(simulator, opened, seconds):
    """Watch a simulator; return the viewers that were opened, all closed by now."""
    view.watch(simulator, seconds)
    assert all(viewer.closed for viewer in opened)
    return opened


def test_no_display_and_one_that_does_not_answer_are_none(monkeypatch):
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setenv("DISPLAY", ":987")
    assert not view.has_display()
    monkeypatch.delenv("DISPLAY")
    monkeypatch.setattr("sys.platform", "linux")
    assert not view.has_display()
