"""Units, signs, order, clocks and gaps: what a map says is what the recording holds."""

from pathlib import Path

import numpy as np
import pytest

from mobnet.core.errors import ConfigError, DataError, near_names
from mobnet.formats.log_map import LogMap
from mobnet.formats.plain import as_plain
from mobnet.robotlog.clocks import ClockBounds
from mobnet.robotlog.columns import LogColumn
from mobnet.robotlog.convert import convert
from mobnet.robotlog.formats import read_log
from mobnet.robotlog.meaning import default_map

RATE_HZ, ROWS = 500.0, 400
TIME = np.arange(ROWS) / RATE_HZ


def columns_of(table, time_s=None):
    return {name: LogColumn(np.asarray(values, dtype=np.float64), time_s) for name, values in table.items()}


@pytest.fixture
def made(arm, settings):
    """Return a function that converts columns of the arm by a map."""

    def convert_arm(columns, **mapping):
        given = {name: {"columns": (f"{name}1", f"{name}2")} for name in ("q", "v", "tau_motor")}
        meaning = LogMap.model_validate(given | mapping)
        return convert("log", columns, meaning, arm.layout, as_plain(settings.robotlog, ClockBounds))

    return convert_arm


@pytest.fixture
def plain():
    angle = 3.0 * TIME
    signals = {"q": np.sin(angle), "v": 3.0 * np.cos(angle), "tau_motor": np.cos(2 * angle)}
    return {"time": TIME, **{f"{name}{k}": k * values for name, values in signals.items() for k in (1, 2)}}


def test_each_number_of_a_map_does_what_it_says(made, plain):
    log = plain | {"q1": np.degrees(plain["q1"]) + 5.0, "q2": -np.degrees(plain["q2"])}
    log["tau_motor2"] = 1e3 * plain["tau_motor2"]
    found = made(
        columns_of(log),
        q={"columns": ("q1", "q2"), "unit": "deg", "sign": (1, -1), "offset": (np.radians(5.0), 0.0)},
        tau_motor={"columns": ("tau_motor1", "tau_motor2"), "unit": "N m", "scale": (1.0, 1e-3)},
    )
    sensed = found.recording.sensed
    np.testing.assert_allclose(sensed.q, np.stack([plain["q1"], plain["q2"]], axis=1), atol=1e-12)
    np.testing.assert_allclose(sensed.tau_motor[:, 1], plain["tau_motor2"], atol=1e-12)
    assert (found.recording.rate_hz, found.recording.segments, found.interpolated) == (RATE_HZ, ((0, ROWS),), False)


def test_columns_stand_in_the_order_of_the_map(made, plain):
    swapped = made(columns_of(plain), q={"columns": ("q2", "q1")}).recording.sensed.q
    np.testing.assert_array_equal(swapped, np.stack([plain["q2"], plain["q1"]], axis=1))


def test_gaps_end_segments_and_nothing_is_made_up_in_them(made, plain):
    kept = np.r_[0:100, 150:ROWS]
    log = {name: values[kept] for name, values in plain.items()}
    found = made(columns_of(log)).recording
    assert found.segments == ((0, 100), (100, ROWS - 50))
    slower = made(columns_of(log), rate_hz=100.0).recording
    assert len(slower.segments) == 2
    assert len(slower.sensed) == pytest.approx((100 + 250) / 5, abs=2)


def test_signals_with_own_clocks_meet_on_one(made, plain):
    """Torques come at a third of the rate and 10 ms late; linear interpolation of a slow sine is close to it."""
    slow = TIME[::3]
    log = columns_of({name: plain[name] for name in ("q1", "q2", "v1", "v2")}, TIME)
    log |= columns_of({f"tau_motor{k}": np.cos(6 * slow) * k for k in (1, 2)}, slow + 0.01)
    late = {"columns": ("tau_motor1", "tau_motor2"), "delay_s": 0.01}
    found = made(log, tau_motor=late)
    assert found.interpolated
    ticks = np.arange(len(found.recording.sensed)) / RATE_HZ
    np.testing.assert_allclose(found.recording.sensed.tau_motor[:, 0], np.cos(6 * ticks), atol=2e-3)


def test_an_even_clock_is_not_resampled_and_an_uneven_one_is(made, plain):
    uneven = TIME + 4e-4 * np.sin(np.arange(ROWS))
    log = plain | {"time": uneven, "q1": np.sin(3.0 * uneven)}
    found = made(columns_of(log), rate_hz=RATE_HZ)
    assert found.interpolated
    ticks = found.clocks["q"][0] + np.arange(len(found.recording.sensed)) / RATE_HZ
    np.testing.assert_allclose(found.recording.sensed.q[:, 0], np.sin(3.0 * ticks), atol=2e-5)


@pytest.mark.parametrize(
    ("log", "mapping", "message"),
    [
        ({"q1": None}, {}, "log: column: 'q1' is not accepted; accepted: q2, tau_motor1"),
        ({}, {"q": {"columns": ("q1",)}}, r"log: q\.columns: number: 1 is not accepted; accepted: 2"),
        ({"time": TIME[::-1]}, {}, "log: clock: row 1 is not after the one before it"),
        ({"v2": np.r_[1.0, np.full(ROWS - 1, np.nan)]}, {}, f"log: column 'v2': 1 of {ROWS} rows have a number"),
        ({"v2": np.r_[TIME[:-1], 1e308]}, {}, f"log: column 'v2', sample {ROWS - 1}: 1e[+]308 is not accepted"),
        (
            {"v2": TIME[:-3]},
            {},
            f"log: column 'v2' has {ROWS - 3} rows, and the clock {ROWS}; accepted: columns of one",
        ),
        (
            {"time": 1e3 * TIME},
            {"rate_hz": 500.0},
            f"log: clock: 399001 ticks at 500 Hz for {ROWS} .* is clock.unit right",
        ),
        ({"time": None}, {}, r"log: clock\.column: 'time' is not accepted; accepted: .*; or give rate_hz"),
    ],
    ids=["column", "number", "clock", "one number", "too large", "shorter", "milliseconds", "no clock"],
)
def test_what_does_not_fit_is_one_line(made, plain, log, mapping, message):
    given = {name: values for name, values in (plain | log).items() if values is not None}
    with pytest.raises(DataError, match=message):
        made(columns_of(given), **mapping)


def test_a_floating_base_needs_its_sensors(layout, settings):
    joints = layout.nu
    rows = np.zeros((20, joints)) + np.arange(20)[:, None]
    names = {name: tuple(f"{name}{k}" for k in range(joints)) for name in ("q", "v", "tau_motor")}
    log = {key: rows[:, k] for name in names for k, key in enumerate(names[name])} | {"time": np.arange(20) / 100}
    meaning = LogMap.model_validate({name: {"columns": keys} for name, keys in names.items()})
    with pytest.raises(ConfigError, match="quaternion, velocity, omega, acc: missing in the map"):
        convert("log", columns_of(log), meaning, layout, as_plain(settings.robotlog, ClockBounds))


def test_base_signals_are_turned_as_the_map_says(layout, settings):
    """A base that stands still, yawed by 90 degrees, drifts along its own x, and its sensor leaves gravity out."""
    rows, half = 50, np.sqrt(0.5)
    log = {"time": np.arange(rows) / 100}
    mapping = {}
    for name in ("q", "v", "tau_motor"):
        mapping[name] = {"columns": tuple(f"{name}{k}" for k in range(layout.nu))}
        log |= {f"{name}{k}": np.zeros(rows) for k in range(layout.nu)}
    vectors = {"quaternion": (0.0, 0.0, half, half), "velocity": (1.0, 0, 0), "omega": (0.0, 0, 0), "acc": (0.0, 0, 0)}
    extra = {"quaternion": {"order": "xyzw"}, "velocity": {"frame": "base"}, "acc": {"gravity": "removed"}}
    for name, vector in vectors.items():
        mapping[name] = {"columns": tuple(f"{name}{k}" for k in range(len(vector))), **extra.get(name, {})}
        log |= {f"{name}{k}": np.full(rows, value) for k, value in enumerate(vector)}
    found = convert(
        "log", columns_of(log), LogMap.model_validate(mapping), layout, as_plain(settings.robotlog, ClockBounds)
    )
    sensed = found.recording.sensed
    np.testing.assert_allclose(sensed.q[:, 3:7], np.tile([half, 0, 0, half], (rows, 1)), atol=1e-12)
    np.testing.assert_allclose(sensed.v[0, :3], [0.0, 1.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(sensed.acc_base_in_base[0], [0.0, 0.0, 9.80665], atol=1e-12)
    assert {"swing", "landing", "left_foot", "right_foot"} <= set(found.absent)


def test_columns_named_as_in_a_recording_need_no_map(clean, arm, stored):
    columns = read_log(stored(clean[:10]))
    meaning = default_map(Path("log.csv"), columns, arm.layout)
    assert meaning.q.columns == ("q.J1", "q.J2")
    assert meaning.acc is None


def test_a_pause_of_a_year_takes_no_memory(made, plain):
    """A computer that gets its time from the network after a start in 1970."""
    slow = {name: values[::2] for name, values in plain.items() if name.startswith("tau")}
    late = np.where(np.arange(ROWS) < 20, TIME, TIME + 3e7)
    log = columns_of({name: values for name, values in plain.items() if name[0] in "qv"}, late)
    found = made(log | columns_of(slow, late[::2]))
    assert found.interpolated
    assert found.recording.segments == ((0, 18), (18, 397))


def test_blank_cells_are_named_and_each_signal_is_taken_on_the_rows_that_it_has(made, plain):
    """Torques come in every other row, and one joint's speed misses a number."""
    every_other = np.where(np.arange(ROWS) % 2 == 0, 1.0, np.nan)
    log = plain | {name: plain[name] * every_other for name in ("tau_motor1", "tau_motor2")}
    log["v1"] = np.where(np.arange(ROWS) == 7, np.nan, plain["v1"])
    found = made(columns_of(log))
    assert [hint.partition(":")[0] for hint in found.hints] == [
        "no number in 1 of 400 rows of v1",
        "no number in 200 of 400 rows of tau_motor1, tau_motor2",
    ]
    rows = len(found.recording.sensed)
    assert rows == ROWS - 1  # up to the last torque
    np.testing.assert_allclose(found.recording.sensed.v[7, 0], plain["v1"][7], atol=1e-3)
    np.testing.assert_allclose(found.recording.sensed.tau_motor[:, 0], plain["tau_motor1"][:rows], atol=1e-3)


def test_a_column_that_ends_early_or_pauses_makes_nothing_up(made, plain):
    kept = (np.arange(ROWS) < 350) & ((np.arange(ROWS) < 100) | (np.arange(ROWS) > 150))
    found = made(columns_of(plain | {"v2": np.where(kept, plain["v2"], np.nan)})).recording
    assert found.segments == ((0, 99), (99, 298))  # and a tick at the end of a stretch has no sample after it
    np.testing.assert_allclose(found.sensed.v[99:, 1], plain["v2"][151:350], atol=1e-12)


def test_rows_that_stand_twice_or_were_exchanged_are_put_in_order(made, plain):
    order = np.r_[0:50, 49, 50:200, 201, 200, 202:ROWS]
    found = made(columns_of({name: values[order] for name, values in plain.items()}))
    assert found.hints[0].startswith(
        f"clock: 2 of {ROWS + 1} times are not after the one before: rows are put in order"
    )
    np.testing.assert_array_equal(found.recording.sensed.v[:, 0], plain["v1"])


def test_a_row_that_comes_late_is_put_in_order_and_times_that_begin_anew_end_a_segment(made, plain):
    order = np.r_[0:100, 120, 100:120, 121:ROWS]
    late = made(columns_of({name: values[np.argsort(order)] for name, values in plain.items()}))
    np.testing.assert_array_equal(late.recording.sensed.q[:, 1], plain["q2"])
    episodes = made(columns_of(plain | {"time": np.r_[TIME[:150], TIME[:250]]}))
    assert episodes.recording.segments == ((0, 150), (150, ROWS))
    assert episodes.hints[0].startswith("clock: times begin anew in row 150, as those of episodes do")
    np.testing.assert_array_equal(episodes.recording.sensed.q[:, 1], plain["q2"])
    short = made(columns_of(plain | {"time": np.r_[TIME[:-2], TIME[:2]]}))
    assert short.recording.segments == ((0, ROWS - 2), (ROWS - 2, ROWS))


def test_names_are_compared_with_the_first_ones_alone():
    """A table of 100 000 columns would take minutes."""
    names = (f"sensor_{k}" if k < 1000 else pytest.fail("too many") for k in range(1010))
    assert near_names(names, "sensor_7")[0] == "sensor_7"
