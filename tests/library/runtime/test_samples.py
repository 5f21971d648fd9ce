"""What the library does with samples that it cannot take: it says so, and its state stays as it was."""

import ctypes

import numpy as np
import pytest
from c_library import MEMORY, NULL, OK, PARTS, SAMPLE, Result, Runtime, Sample

from mobnet.core.columns import recording_columns

from .conftest import changed, moving, network_of, watching

NAMES = ("residual", "tau_ext", "mean", "std")


@pytest.fixture
def started(runtime, observer_of):
    """A function of a machine that returns it with a network and a detector, and smooth motion."""

    def start(machine):
        observer = observer_of(machine)
        layout, limb = observer.nominal.robot.layout, "W" if machine == "robot" else "A"
        parts = [network_of(layout, limb, {"cell": "GRU", "hidden": 8})], [watching(layout, limb, ("mean", "std"))]
        return runtime(observer, *parts), moving(layout, 60), layout

    return start


def told(runtime):
    return [runtime.told(name) for name in NAMES] + [np.array(runtime.alarms())]


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300, -1e9])
@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_a_number_that_is_not_accepted_is_named_in_every_column(started, machine, value):
    runtime, sensed, layout = started(machine)
    columns = recording_columns(layout)
    assert runtime.step(sensed[0]) == OK
    before = told(runtime)
    for part in PARTS:
        for k, (name, _, _) in enumerate(columns[part]):
            array = getattr(sensed[1], part).copy()
            array[k] = value
            assert runtime.step(changed(sensed[1], **{part: array})) == SAMPLE
            assert runtime.name("column_name", runtime.result.fault) == name
    for one, other in zip(told(runtime), before, strict=True):
        np.testing.assert_array_equal(one, other)


def test_columns_are_those_of_a_recording(started):
    for machine in ("robot", "arm"):
        runtime, _, layout = started(machine)
        names = [name for part in PARTS for name, _, _ in recording_columns(layout)[part]]
        assert [runtime.name("column_name", k) for k in range(runtime.sizes.columns)] == names
        assert runtime.name("column_name", len(names)) is None
        assert [runtime.name("joint_name", k) for k in range(runtime.sizes.nv)] == list(layout.names)
        assert runtime.name("joint_name", layout.nv) is None


def test_signals_are_named(started):
    runtime, _, layout = started("arm")
    kinds, joints = (zip(*[(runtime.name("signal_kind", 0, k), runtime.name("signal_joint", 0, k)) for k in range(4)],
                         strict=True))  # fmt: skip
    assert (kinds, joints) == (("mean", "mean", "std", "std"), layout.names * 2)
    assert runtime.name("detector_name", 0) == "A"
    assert (
        runtime.name("signal_kind", 0, 4)
        is runtime.name("signal_joint", 1, 0)
        is runtime.name("detector_name", 1)
        is None
    )


def test_a_quaternion_of_another_length_is_refused(started):
    runtime, sensed, _ = started("robot")
    q = sensed[0].q.copy()
    q[3:7] *= 0.9
    assert runtime.step(changed(sensed[0], q=q)) == SAMPLE
    assert runtime.name("column_name", runtime.result.fault) == "q.quat_w"


@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_a_refused_sample_holds_the_residual_for_one_more_and_goes_on(started, machine):
    """The step over a gap would show a change of momentum of two periods as a torque."""
    runtime, sensed, layout = started(machine)
    for k in range(30):
        assert runtime.step(sensed[k]) == OK
    held = runtime.told("residual")
    assert runtime.step(changed(sensed[30], q=np.full(layout.nq, np.nan))) == SAMPLE
    assert runtime.step(sensed[31]) == OK
    np.testing.assert_array_equal(runtime.told("residual"), held)
    assert runtime.step(sensed[32]) == OK
    moved = runtime.told("residual")
    assert not np.array_equal(moved, held)
    assert np.abs(moved - held).max() < 0.2 * np.abs(held).max()


@pytest.mark.parametrize("machine", ["robot", "arm"])
def test_after_a_reset_all_is_as_at_first(started, machine):
    runtime, sensed, _ = started(machine)
    runs = []
    for _ in range(2):
        runtime.reset()
        found = []
        for k in range(len(sensed)):
            assert runtime.step(sensed[k]) == OK
            found += told(runtime)
        runs.append(np.concatenate([np.ravel(part) for part in found]))
    np.testing.assert_array_equal(*runs)
    assert np.any(runs[0])


def test_handles_do_not_know_each_other(library, started, tmp_path):
    runtime, sensed, _ = started("arm")
    model = (tmp_path / "model.bin").read_bytes()
    alone, beside = Runtime(library, model), Runtime(library, model)
    for k in range(len(sensed)):
        assert runtime.step(sensed[k]) == alone.step(sensed[k]) == OK
        assert beside.step(sensed[-k]) == OK
        for one, other in zip(told(runtime), told(alone), strict=True):
            np.testing.assert_array_equal(one, other)


def test_null_and_too_little_memory_are_told(library, started, tmp_path):
    runtime, _, _ = started("robot")
    assert library.mobnet_step(None, ctypes.byref(Sample()), ctypes.byref(Result())) == NULL
    assert library.mobnet_step(runtime.handle, ctypes.byref(Sample()), ctypes.byref(Result())) == NULL
    library.mobnet_reset(None)
    model, handle = (tmp_path / "model.bin").read_bytes(), ctypes.c_void_p()
    words = model, ctypes.c_size_t(len(model)), ctypes.byref(handle)
    assert library.mobnet_init(runtime.memory, ctypes.c_size_t(runtime.size - 1), *words) == MEMORY
    assert not handle.value
    assert library.mobnet_size(None, ctypes.c_size_t(0), ctypes.byref(ctypes.c_size_t())) == NULL


def test_every_status_has_a_text(library):
    texts = [library.mobnet_text(status) for status in range(12)]
    assert len({*texts}) == 12
    assert library.mobnet_text(12) is library.mobnet_text(-1) is None
