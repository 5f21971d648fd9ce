"""Mistakes that labs make with logs are named, each by its own hint, and a clean log has none."""

import re
from pathlib import Path

import numpy as np
import pytest

from mobnet.core.contract import BEYOND_SPEED
from mobnet.formats.loading import load_section
from mobnet.formats.plain import as_plain
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robot.dynamics import gravity
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.base import _turning
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.hints.changes import _improves
from mobnet.robotlog.hints.delay import EXACT, _unexplained
from mobnet.robotlog.hints.explained import _in_words
from mobnet.robotlog.hints.fits import positive_fit
from mobnet.robotlog.hints.motion import jump_hints
from mobnet.robotlog.observe import observe_log

ARM = Path("tests/data/arm.yaml")
BOTH = ("J1", "J2")
LATE = 12  # samples
TWELVE = r"(11\.[5-9]\d?|12(\.[0-4]\d?)?)"  # of them, within half a sample
DELAYS = [  # rate of a log [Hz], and how late its torques are [ms]
    (50.0, 40.0), (50.0, 50.0), (100.0, 20.0), (100.0, 25.0), (100.0, -30.0), (100.0, 80.0), (250.0, 8.0),
    (250.0, 80.0), (500.0, 4.0), (1000.0, 3.0), (1000.0, 80.0),
]  # fmt: skip
RATE_HZ = 1000.0  # of the logs
SEEDS = range(5)


def changed(table, joints, signals, function):
    """Return a log with a function applied to some signals of some joints."""
    names = [f"{signal}.{joint}" for signal in signals for joint in joints]
    return table.assign(**{name: function(table[name].to_numpy()) for name in names})


def exchanged(table, signals):
    one, other = BOTH
    swapped = {f"{s}.{a}": table[f"{s}.{b}"] for s in signals for a, b in ((one, other), (other, one))}
    return table.assign(**swapped)


def late(column):
    return np.r_[np.repeat(column[0], LATE), column[:-LATE]]


def jittered(table):
    return table.assign(time=np.sort(table["time"] + np.random.default_rng(3).uniform(-4e-4, 4e-4, len(table))))


def clipped(column):
    largest = np.quantile(np.abs(column), 0.9)
    return column.clip(-largest, largest)


def held(column):
    return np.repeat(column[::10], 10)[: len(column)]


def lost(column):
    return np.where(np.isin(np.arange(len(column)), (3000, 7000, 7001)), 0.0, column)


def wrapped(column):
    """Return an angle that a sensor counts from zero to a full turn."""
    return np.mod(column, 2 * np.pi)


def with_speeds_as_positions(table):
    return table.assign(**{f"{a}.{j}": table[f"{b}.{j}"] for j in BOTH for a, b in (("q", "v"), ("v", "q"))})


def with_gravity(table, times):
    """Return a log with the torque of gravity so many times more."""
    nominal = NominalModel(describe(load_section(ARM, RobotTable)))
    load = times * np.array([gravity(nominal, q) for q in table[["q.J1", "q.J2"]].to_numpy()])
    return table.assign(**{f"tau_motor.{j}": table[f"tau_motor.{j}"] + load[:, k] for k, j in enumerate(BOTH)})


def without_gravity(table):
    return with_gravity(table, -1.0)


def with_gravity_twice(table):
    return with_gravity(table, 1.0)


MISTAKES = {  # name -> what a lab does to its log, and the hint
    "torque of the wrong sign": (
        lambda t: changed(t, ["J2"], ["tau_motor"], np.negative),
        "J2: tau_motor is of the wrong sign",
    ),
    "torque before the gear": (
        lambda t: changed(t, ["J1"], ["tau_motor"], lambda x: x / 100),
        r"J1: tau_motor is 1/(9\d|10\d).* of what the motion needs: before the gear, or a current in A\?",
    ),
    "torques exchanged": (lambda t: exchanged(t, ["tau_motor"]), "J1 and J2: tau_motor of the two is exchanged"),
    "joints exchanged": (lambda t: exchanged(t, ["q", "v", "tau_motor"]), "J1 and J2: the two joints are exchanged"),
    "positions in degrees": (lambda t: changed(t, BOTH, ["q"], np.degrees), "q of J1, J2: .* 57.3 times .* degrees"),
    "speeds in degrees": (lambda t: changed(t, BOTH, ["v"], np.degrees), "q of J1, J2: .* 0.0175 times .* deg/s"),
    "both in degrees": (lambda t: changed(t, BOTH, ["q", "v"], np.degrees), "q of J1, J2: .* in degrees"),
    "torque in mN m": (lambda t: changed(t, BOTH, ["tau_motor"], lambda x: 1e3 * x), "J1 and J2: tau_motor is in mN m"),
    "a column twice": (lambda t: t.assign(**{"v.J2": t["v.J1"]}), "v of J1 and J2: the same numbers in both"),
    "a constant column": (lambda t: t.assign(**{"tau_motor.J2": 1.5}), "tau_motor of J2: never changes, 1.5"),
    "jitter": (jittered, r"clock of q, v, tau_motor: intervals of .* ms spread by \d\d%"),
    "a gap": (lambda t: t.drop(index=range(5000, 5400)), "clock of .*: 1 gap, the longest 0.401 s"),
    "clipped torque": (lambda t: changed(t, ["J1"], ["tau_motor"], clipped), "tau_motor of J1: 10.0% of the samples"),
    "a joint counted backwards": (
        lambda t: changed(t, ["J2"], ["q", "v"], np.negative),
        "J2: q and v have the wrong sign",
    ),
    "an axis the other way": (
        lambda t: changed(t, ["J2"], ["q", "v", "tau_motor"], np.negative),
        "J2: q, v and tau_motor have the wrong sign",
    ),
    "speed of the wrong sign": (lambda t: changed(t, ["J1"], ["v"], np.negative), "q of J1: changes by -1 times"),
    "late torque": (lambda t: changed(t, BOTH, ["tau_motor"], late), f"tau_motor: {TWELVE} ms late against the motion"),
    "held speed": (lambda t: changed(t, BOTH, ["v"], held), "v of J1, J2: 90% of the samples repeat"),
    "clock in ns": (lambda t: t.assign(time=1e9 * t["time"]), r"clock of .*: 1e\+06 s between samples: in ns\?"),
    "clock in us": (lambda t: t.assign(time=1e6 * t["time"]), r"clock of .*: 1e\+03 s between samples: in us"),
    "a number in place of a clock": (
        lambda t: t.assign(time=np.arange(len(t))),
        "q of J1, J2: .* the clock in ms",
    ),
    "speed by sample": (lambda t: changed(t, BOTH, ["v"], lambda x: x / 1e3), "v in rad from one sample to the next"),
    "positions and speeds exchanged": (with_speeds_as_positions, "q and v of J1, J2: .*: exchanged"),
    "a wrapped angle": (lambda t: changed(t, ["J2"], ["q"], wrapped), "q of J2: jumps .* 6.2. rad .*: wrapped"),
    "lost samples": (lambda t: changed(t, ["J1"], ["q"], lost), "q of J1: jumps .*: samples are lost or wrong"),
    "another zero": (
        lambda t: changed(t, ["J2"], ["q"], lambda x: x + np.pi / 2),
        r"J2: q reads \+1\.\d+ rad \(\+9\d degrees\) too much",
    ),
    "a full turn too much": (
        lambda t: changed(t, ["J2"], ["q"], lambda x: x + 2 * np.pi),
        r"q of J2: beyond the robot's table by a full turn too much: it reaches .*; give offset: 6\.283185",
    ),
    "two full turns too little": (
        lambda t: changed(t, ["J2"], ["q"], lambda x: x - 4 * np.pi),
        r"q of J2: beyond the robot's table by 2 full turns too little: it reaches .*; give offset: -12\.56637",
    ),
    "late speed": (lambda t: changed(t, BOTH, ["v"], late), f"v of J1, J2: {TWELVE} ms late against q"),
    "held torque": (lambda t: changed(t, BOTH, ["tau_motor"], held), "tau_motor of J1, J2: 90% of the samples repeat"),
    "torque without gravity": (without_gravity, "J1 and J2: tau_motor lacks the torque of gravity"),
    "all torques of the wrong sign": (
        lambda t: changed(t, BOTH, ["tau_motor"], np.negative),
        "J1 and J2: tau_motor is of the wrong sign",
    ),
    "motor currents": (
        lambda t: t.assign(**{f"tau_motor.{j}": t[f"tau_motor.{j}"] / size for j, size in (("J1", 9.1), ("J2", 4.2))}),
        r"J1 and J2: tau_motor is 1/4\.[0-4]\d* to (8\.[89]|9)\.?\d* of what the motion needs: .* or a current in A\?",
    ),
    "an offset": (
        lambda t: changed(t, ["J1"], ["tau_motor"], lambda x: x - 20),
        r"J1: tau_motor reads -(19|20)\.?\d* N m too much all the time: an offset",
    ),
    "torque with gravity twice": (
        with_gravity_twice,
        "J1.*: tau_motor has the torque of gravity twice",
    ),
    "clock in ms": (lambda t: t.assign(time=1e3 * t["time"]), "q of J1, J2: .* the clock in ms"),
}  # fmt: skip


@pytest.fixture
def hints(arm, settings, stored):
    def find(table):
        return observe_log(stored(table), arm, None, "sample", 100.0, 9.81, settings.robotlog).hints

    return find


@pytest.mark.parametrize("seed", SEEDS)
def test_a_clean_log_has_no_hint(seed, arm_log, hints):
    assert hints(arm_log(seed)) == ()


@pytest.mark.parametrize("name", MISTAKES)
def test_each_mistake_has_a_hint_that_names_it(name, clean, hints):
    spoil, pattern = MISTAKES[name]
    found = hints(spoil(clean))
    matching = [hint for hint in found if re.search(pattern, hint)]
    assert matching, found
    named = [hint for hint in found if hint not in matching]
    assert all("beyond" in hint for hint in named), named  # and it names nothing else but values beyond limits


@pytest.mark.parametrize(("offset", "words"), [(2.0, "2"), (3.0, "at least 3"), (-3.0, "-3 or less")])
def test_an_offset_at_the_bound_of_its_fit_may_be_larger(offset, words):
    assert _in_words(offset, 3.0) == words


@pytest.mark.parametrize("size", [0.0, 1e-300, 1e-150, 1e12])
@pytest.mark.parametrize("signal", ["q", "v", "tau_motor"])
@pytest.mark.parametrize("joints", [["J1"], BOTH], ids="+".join)
def test_numbers_of_any_size_give_hints_without_a_warning(joints, signal, size, clean, hints):
    assert isinstance(hints(changed(clean[::10], joints, [signal], lambda column: size * column)), tuple)


@pytest.mark.parametrize(("rate_hz", "late_ms"), DELAYS)
def test_a_delay_is_told_within_half_a_sample(rate_hz, late_ms, clean, hints):
    t = clean["time"].to_numpy()
    table = changed(clean, BOTH, ["tau_motor"], lambda column: np.interp(t - late_ms / 1e3, t, column))
    (hint,) = hints(table[:: round(RATE_HZ / rate_hz)])
    found = re.match(r"tau_motor: ([\d.]+) ms (late|early) against the motion", hint)
    assert found, hint
    told_ms = float(found[1]) * (1 if found[2] == "late" else -1)
    assert abs(told_ms - late_ms) < 500.0 / rate_hz


@pytest.mark.parametrize("rate_hz", [8.0, 50.0, 100.0, 250.0, 500.0])  # at the first a mean is of one sample
def test_a_log_without_a_delay_has_no_hint_at_any_rate(rate_hz, clean, hints):
    assert hints(clean[:: round(RATE_HZ / rate_hz)]) == ()


@pytest.mark.parametrize(("step", "jumps"), [(0.1, False), (0.99, False), (1.01, True)])
def test_a_joint_at_rest_jumps_where_it_is_beyond_its_speed(arm, step, jumps):
    """Its usual step is none, so that a count of its encoder is any number of times that."""
    speed = arm.layout.limits["J1"].speed
    q = np.zeros((1000, len(arm.layout.actuated)))
    q[500:, 0] = step * BEYOND_SPEED * speed / RATE_HZ
    found = list(jump_hints(q, [slice(0, len(q))], RATE_HZ, arm.layout))
    assert [hint.startswith("q of J1: jumps 1 time,") for hint in found] == [True] * jumps


def test_terms_that_nothing_tells_apart_explain_what_they_can():
    """A joint at one speed all the time: its dry and viscous friction are alike, and its inertia takes no torque."""
    terms = np.tile([1.0, 0.5, 0.0], (64, 1))
    numbers = positive_fit(terms, np.full((64, 1), 3.0))
    assert (numbers >= 0.0).all()
    np.testing.assert_allclose(terms @ numbers, 3.0, rtol=1e-6)


@pytest.mark.parametrize(("left", "before", "improves"), [(0.4, 1.0, False), (0.2, 1.0, True), (0.2, 0.5, False)])
def test_a_change_leaves_little_and_much_less_than_before(settings, left, before, improves):
    assert _improves(left, before, as_plain(settings.robotlog, HintBounds)) == improves


@pytest.mark.parametrize("rate_hz", [2.0, 100.0])  # at the first a window is shorter than a sample
def test_a_base_turns_as_its_rates_say(settings, rate_hz):
    angle = 0.1 * np.arange(1000) / rate_hz
    quat, omega = np.zeros((4, 1000)), np.zeros((3, 1000))
    quat[0], quat[3], omega[2] = np.cos(angle / 2), np.sin(angle / 2), 0.1
    found = _turning(quat, omega, [slice(0, 1000)], rate_hz, as_plain(settings.robotlog, HintBounds))
    assert found == pytest.approx(1.0, rel=1e-2)


def test_a_base_that_never_turns_tells_nothing(settings):
    quat = np.tile([[1.0], [0.0], [0.0], [0.0]], (1, 1000))
    assert (
        _turning(quat, np.zeros((3, 1000)), [slice(0, 1000)], RATE_HZ, as_plain(settings.robotlog, HintBounds)) is None
    )


def test_what_is_explained_in_full_leaves_a_share_whose_logarithm_is_known():
    terms = np.random.default_rng(0).uniform(1.0, 2.0, (50, 1, 2))
    given = (terms @ [1.0, 2.0])[:, None, :]
    np.testing.assert_allclose(_unexplained(terms, given), EXACT)
