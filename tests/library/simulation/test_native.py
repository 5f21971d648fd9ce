"""The C structs are read as Python's own views read them, and the compiled call is MuJoCo's step."""

import mujoco
import numpy as np
import pytest
from numba import njit

from mobnet.core.errors import SimulationError
from mobnet.settings.data import Flat
from mobnet.simulation import native
from mobnet.simulation.native import READ, addresses_at, bind, c_struct, call_step, doubles_at, ints_at, offsets
from mobnet.simulation.terrain import draw_terrain
from mobnet.simulation.world import make_world

POINTERS = ("qpos", "qvel", "ctrl", "qfrc_applied", "xpos", "sensordata", *set(READ) - {"nefc"})


@pytest.fixture
def world(settings, robot):
    """Feet on the ground, so that there are contact rows."""
    flat = draw_terrain(Flat(), np.random.default_rng(0))
    world = make_world(robot, flat, settings.plant, settings.levels["ideal"], settings.rates.plant_hz)
    world.data.qpos[2] = 2 * robot.leg.link_length - robot.leg.hip_pos[2] - robot.sole.height - 1e-3
    mujoco.mj_forward(world.model, world.data)
    return world


def test_struct_offsets_read_what_python_s_views_hold(world):
    raw, data = c_struct("mjData").from_address(world.data._address), world.data
    assert data.nefc > 0
    for field in ("nefc", "ncon", "ne", "nf"):
        assert getattr(raw, field) == getattr(data, field)
    assert raw.time == data.time
    for field in POINTERS:
        assert getattr(raw, field) == getattr(data, field).ctypes.data


def test_compiled_code_reads_the_constraint_rows(world):
    @njit
    def read(data, nefc, kind, force, row):
        kinds, forces = ints_at(addresses_at(data + kind)[0]), doubles_at(addresses_at(data + force)[0])
        return ints_at(data + nefc)[0], kinds[row], forces[row]

    at, data = bind(world.model, world.data), world.data
    for row in range(data.nefc):
        found = read(at.data, at.nefc, at.efc_type, at.efc_force, row)
        assert found == (data.nefc, data.efc_type[row], data.efc_force[row])


def test_call_by_address_is_mujoco_s_step_to_the_bit(world):
    @njit
    def step(function, model, data):
        call_step(function, model, data)

    at = bind(world.model, world.data)
    twin = mujoco.MjData(world.model)
    twin.qpos[:] = world.data.qpos
    mujoco.mj_forward(world.model, twin)
    for _ in range(20):
        step(at.step, at.model, at.data)
        mujoco.mj_step(world.model, twin)
    np.testing.assert_array_equal(world.data.qpos, twin.qpos)
    np.testing.assert_array_equal(world.data.efc_force, twin.efc_force)


@pytest.mark.parametrize("shift", [-8, 4, 8])
@pytest.mark.parametrize("field", READ)
def test_a_field_that_lies_elsewhere_is_refused(monkeypatch, field, shift):
    offset = native.offset
    monkeypatch.setattr(native, "offset", lambda name: offset(name) + shift * (name == field))
    with pytest.raises(SimulationError, match=rf"^mjData\.{field}: \d+ by its address, Python says \d+$"):
        offsets.__wrapped__()


@pytest.mark.parametrize("field", [name for name in READ if name != "nefc"])
def test_a_field_of_another_type_is_refused(monkeypatch, field):
    monkeypatch.setitem(READ, field, np.int64)
    with pytest.raises(SimulationError, match=rf"^mjData\.{field}: type \w+ is not accepted; accepted: int64$"):
        offsets.__wrapped__()
