"""Watch a scenario in MuJoCo's viewer, at the pace of real time, or take states from it for pictures."""

import os
import sys
import time
import warnings
from collections.abc import Iterator

import mujoco
import numpy as np

from mobnet.core.arrays import Array
from mobnet.simulation.render import aim, picture_model
from mobnet.simulation.simulator import Simulator

SYNC_S = 0.01  # simulated between two looks of the viewer
SHADOW_PIXELS = 2048  # of the viewer's shadow; a still picture has more
MID_STRIDE = 0.6  # of a step's time; the swinging foot is then ahead of the other and still in the air
LOOKED_FOR_S = 3.0  # a left step comes within this time


def walk(simulator: Simulator, seconds: float, every_s: float) -> Iterator[Array]:
    """Walk a started simulator; yield q (nq,) [m, rad] now and after every so many seconds, until a fall."""
    samples = round(every_s * simulator.settings.rates.data_hz)
    rows = np.zeros((samples, simulator.width), dtype=np.float32)
    end = simulator.state.clock + seconds - every_s / 2
    yield simulator.world.data.qpos.copy()
    while simulator.state.clock < end and simulator.run(rows) == samples:
        yield simulator.world.data.qpos.copy()


def upright(simulator: Simulator) -> bool:
    """Return whether the robot has not fallen."""
    return bool(simulator.world.data.qpos[2] > simulator.plant.fall_height)


def walk_to_mid_stride(simulator: Simulator) -> None:
    """Walk on until the left foot is in the air and ahead of the right one, or no such moment comes."""
    s = simulator.state
    for _ in walk(simulator, LOOKED_FOR_S, SYNC_S):
        if s.swinging == 1 and s.side < 0 and s.t > MID_STRIDE * s.total:
            return


def has_display() -> bool:
    """Return whether a window can be opened; the viewer itself would wait for one for ever."""
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return False
    import glfw  # loads a library that only windows need

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return bool(glfw.init())


def watch(simulator: Simulator, seconds: float) -> None:
    """Walk in MuJoCo's viewer until its window is closed; after a fall, or the time given, the robot is still."""
    from mujoco.viewer import launch_passive  # needs a display

    model = picture_model(simulator.robot, simulator.world.terrain)
    model.vis.quality.shadowsize = SHADOW_PIXELS
    data = mujoco.MjData(model)  # what the window shows and a mouse may pull is not the plant
    data.qpos[:] = simulator.world.data.qpos
    with launch_passive(model, data, show_left_ui=False, show_right_ui=False) as viewer:
        with viewer.lock():
            aim(viewer.cam, data.qpos[:3])
        begin = time.perf_counter() - simulator.state.clock
        for q in walk(simulator, seconds, SYNC_S):
            if not viewer.is_running():
                return
            with viewer.lock():
                viewer.cam.lookat[:] += q[:3] - data.qpos[:3]  # with the robot, also where it is put back by a period
                data.qpos[:] = q
                mujoco.mj_forward(model, data)
            viewer.sync()
            time.sleep(max(0.0, begin + simulator.state.clock - time.perf_counter()))
        while viewer.is_running():
            time.sleep(SYNC_S)
