"""Numbers that no walk, and no file made from one, can have at its place are refused by a check."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from made_places import LEVEL, SCENARIO, Change, estimated, note_of

from mobnet.agreement import check_agreement
from mobnet.core.columns import FEET, recording_columns, torque_columns
from mobnet.core.errors import DataError
from mobnet.core.store import read_array, write_array
from mobnet.estimation.low_pass import low_pass
from mobnet.plan.runs import Files


def refused(path: Path, files: Files) -> str:
    """Return the lines with which a file, or the array beside a note, is refused by a check."""
    with pytest.raises(DataError) as found:
        check_agreement(both_files(path), files, numbers=True)
    return str(found.value)


def both_files(path: Path) -> Sequence[Path]:
    """Return the note and the array of a place."""
    return path.with_suffix(".json"), path.with_suffix(".parquet")


def ground(files: Files, change: Change = lambda signals: None, scenario: str = SCENARIO, seed: int = 101) -> Path:
    """Write the columns of a walk in which the left foot carries the robot and then the right one."""
    layout, weight = files.settings.layout, 940.0
    left = np.repeat([1.0, 0.0], 5000)
    signals = {
        "q.base_x": np.linspace(0, 1, 10000), "v.base_x": np.full(10000, 0.1), "q.base_z": np.full(10000, 0.9),
        "tau_ext.V3": np.full(10000, weight), "tau_ext.LL4": 90.0 * left, "tau_des.LL4": 80.0 * left,
        "tau_motor.LL4": 80.0 * left,
        "tau_push.LL3": np.zeros(10000), "pushed": np.zeros(10000), "tau_random.LL3": np.zeros(10000),
        "command.step_x": np.full(10000, 0.1),
    }  # fmt: skip
    for foot, carries in (("left_foot", left), ("right_foot", 1.0 - left)):
        signals |= {
            f"wrench_{foot}.force_z": weight * carries,
            f"contact.{foot}": carries,
            f"swing.{foot}": 1.0 - carries,
        }
    change(signals)
    known = {name: column for group in recording_columns(layout).values() for name, *column in group}
    columns = [(name, *known[name]) for name in signals]
    path, note = note_of(files, "recordings")
    note |= {"scenario": scenario, "seed": seed, "falls": int(scenario != SCENARIO)}  # a fall explains missing rows
    path = files.array("recordings", scenario, LEVEL, seed).with_suffix(".json")
    meta = {key: note[key] for key in ("rate_hz", "scenario", "level", "seed", "falls")}
    write_array(path.with_suffix(""), np.stack(list(signals.values()), axis=1), columns, meta)
    return path.with_suffix(".parquet")


def times(factor: float, *names: str) -> Callable[[dict[str, Any]], None]:
    """Return a change of signals that multiplies some of them."""
    return lambda signals: signals.update({name: factor * signals[name] for name in names})


def put(name: str, value: float) -> Change:
    """Return a change of signals that gives one a value at every sample."""
    return lambda signals: signals.update({name: np.full(10000, value)})


def flipped(flag: str) -> Callable[[dict[str, Any]], None]:
    """Return a change of signals that turns the flags of the feet round."""
    return lambda signals: signals.update({n: 1.0 - signals[n] for n in (f"{flag}.left_foot", f"{flag}.right_foot")})


def both(flag: str, value: float) -> Callable[[dict[str, Any]], None]:
    """Return a change of signals that gives the flags of both feet a value."""
    return lambda signals: signals.update({f"{flag}.{foot}": np.full(10000, value) for foot in FEET})


NUMBERS: dict[str, tuple[Change, str]] = {
    "forces in kN": (
        times(1e-3, "wrench_left_foot.force_z", "wrench_right_foot.force_z"),
        "of both feet: mean: 0.94 is",
    ),
    "the ground pulls": (times(-1.0, "tau_ext.V3"), "columns tau_ext.V3: mean: -940.0 is not"),
    "contact": (flipped("contact"), "column contact.left_foot: "),
    "swing": (flipped("swing"), "column swing.left_foot: "),
    "backwards": (times(-1.0, "q.base_x"), "column q.base_x: displacement: '-1 times what v.base_x says' is"),
    "cm": (times(100.0, "q.base_x"), "column q.base_x: displacement: '100 times"),
    "at rest and moving": (times(0.0, "v.base_x"), "column q.base_x: displacement: 'inf times"),
    "below the ground": (times(-1.0, "q.base_z"), "column q.base_z: mean: -0.9 is not accepted; accepted: above 0"),
    "a motor against its torque": (times(-1.0, "tau_motor.LL4"), "column tau_motor.LL4: '113 N m away from tau_des"),
    "a motor without torque": (times(0.0, "tau_motor.LL4"), "column tau_motor.LL4: '56.6 N m away from tau_des"),
    "N mm": (times(1e3, "tau_ext.LL4"), "column tau_ext.LL4: largest number: 90000.0 is not accepted; accepted: at mo"),
    "both swing": (both("swing", 1.0), "columns swing.*: share of both at once: 1.0 is not"),
    "no contact": (both("contact", 0.0), "column contact.left_foot: mean force where it is 0: 470.0 is not"),
    "always contact": (both("contact", 1.0), "column contact.left_foot: share of 1 without force: 0.5 is not"),
    "a mark": (lambda s: s["pushed"].__iadd__(1.0), "column pushed: largest number: 1.0 is not accepted; accepted: 0"),
    "a push": (lambda s: s["tau_push.LL3"].__iadd__(30.0), "column tau_push.LL3: largest number: 30.0 is not"),
    "a random torque": (
        lambda s: s["tau_random.LL3"].__iadd__(3.0),
        "column tau_random.LL3: largest number: 3.0",
    ),
    "a command": (times(9.0, "command.step_x"), "column command.step_x, row 0: 0.89999"),
}


@pytest.mark.parametrize("name", NUMBERS)
def test_numbers_that_no_walk_of_the_scenario_has_are_refused(name: str, files: Files) -> None:
    change, says = NUMBERS[name]
    check_agreement([ground(files)], files, numbers=True)
    path = ground(files, change)
    check_agreement([path], files)  # a run looks at notes alone
    with pytest.raises(DataError) as found:
        check_agreement([path], files, numbers=True)
    assert says in str(found.value)


PUSHES: dict[str, tuple[str, Change, str]] = {
    "no random torque": ("random_walk", lambda s: None, "columns tau_random.*: largest number: 0.0 is not accepted"),
    "large random torque": (
        "random_walk",
        lambda s: s["tau_random.LL3"].__iadd__(99.0),
        ": 99.0 is not accepted",
    ),
    "another joint": ("hip_pitch_step", put("tau_push.LL4", 30.0), "column tau_push.LL4: largest number: 30.0 is not"),
    "larger": (
        "hip_pitch_step",
        put("tau_push.LL3", 300.0),
        "tau_push.LL3: largest number: 300.0 is not",
    ),
    "not marked": ("hip_pitch_step", lambda s: s["tau_push.LL3"].__iadd__(30.0), "column pushed, row 0: 0.0 is not"),
    "marked": (
        "hip_pitch_step",
        lambda s: s["pushed"].__iadd__(1.0),
        "share of 1 without tau_push: 1.0 is not",
    ),
}


@pytest.mark.parametrize("name", PUSHES)
def test_torques_that_the_scenario_does_not_add_are_refused(name: str, files: Files) -> None:
    scenario, change, says = PUSHES[name]
    seed = files.training_seeds("walk")[0] if scenario == "random_walk" else files.test_seeds[0]
    assert says in refused(ground(files, change, scenario, seed), files)


def test_the_same_array_under_two_seeds_is_refused(files: Files) -> None:
    seeds = files.training_seeds("walk_plain")[0], 7
    check_agreement([ground(files, scenario="random_walk_plain", seed=seeds[0])], files, numbers=True)
    ground(files, scenario="random_walk_plain", seed=seeds[1])
    path = ground(files, scenario="random_walk_plain", seed=seeds[0])
    assert "array: 'that of s7' is not accepted" in refused(path, files)


def residual(files: Files, change: Change = lambda signals: None) -> Path:
    """Write the residual of a walk that is its external torque, and the walk."""
    layout, gain = files.settings.layout, files.settings.observer.gain_hz
    rng = np.random.default_rng(3)
    truth = np.cumsum(rng.normal(size=(2000, layout.nv)), axis=0)
    truth[:, 2] += 940.0
    path, note = note_of(files, "recordings")
    meta = {key: note[key] for key in ("rate_hz", "scenario", "level", "seed")} | {"falls": 1}
    write_array(path.with_suffix(""), truth, torque_columns(layout, ["tau_ext"], layout.names), meta)
    exact = low_pass(truth, gain, 1000.0)
    signals = {f"r.{joint}": exact[:, k].copy() for k, joint in enumerate(layout.names)}
    signals |= {f"tau_ext_lp.{joint}": exact[:, k].copy() for k, joint in enumerate(layout.names)}
    change(signals)
    stem = note_of(files, "residuals")[0].with_suffix("")
    ratio = files.settings.levels[LEVEL].nominal_mass_ratio
    meta |= {"gain_hz": gain, "nominal_mass_ratio": ratio}
    columns = torque_columns(layout, ["r", "tau_ext_lp"], layout.names)
    write_array(stem, np.stack(list(signals.values()), axis=1), columns, meta)
    return stem.with_suffix(".parquet")


def swapped(signals: dict[str, Any]) -> None:
    """Exchange the residuals of the legs."""
    for k in range(1, 7):
        signals[f"r.LL{k}"], signals[f"r.RL{k}"] = signals[f"r.RL{k}"], signals[f"r.LL{k}"]


RESIDUALS: dict[str, tuple[Change, str]] = {
    "late": (lambda s: s.update({"tau_ext_lp.LL4": np.roll(s["tau_ext_lp.LL4"], 9)}), "column tau_ext_lp.LL4: differ"),
    "stuck": (lambda s: s["r.LL4"].__setitem__(slice(None), 3.0), "column r.LL4: every number: 3.0 is not"),
    "the ground pulls": (lambda s: s["r.V3"].__imul__(-1.0), "column r.V3: mean: "),
    "sides": (swapped, "columns r.LL1 to RL6: "),
}


@pytest.mark.parametrize("name", RESIDUALS)
def test_residuals_that_are_not_of_their_recording_are_refused(name: str, files: Files) -> None:
    check_agreement([residual(files)], files, numbers=True)
    assert RESIDUALS[name][1] in refused(residual(files, RESIDUALS[name][0]), files)


def estimate(files: Files, method: str, factor: float) -> Path:
    """Write the estimate of a method that is so many times the residual."""
    joints = estimated(files)
    array = factor * read_array(residual(files).with_suffix(""), [f"r.{joint}" for joint in joints])[0]
    path, note = note_of(files, f"estimates/{method}/n0")
    meta = {key: note[key] for key in ("rate_hz", "scenario", "level", "seed")} | {"method": method, "networks": {}}
    write_array(path.with_suffix(""), array, torque_columns(files.settings.layout, ["tau_ext"], joints), meta)
    return path.with_suffix(".parquet")


@pytest.mark.parametrize(
    ("method", "good", "bad", "says"),
    [
        ("MOB", 1.0, -1.0, "column tau_ext.LL1: difference: "),
        ("zero", 0.0, 1.0, "column tau_ext.LL1: largest number: "),
        ("MOB-fric", 0.7, 0.0, "column tau_ext.LL1: every number: 0.0 is not"),
    ],
)
def test_estimates_that_the_method_does_not_make_are_refused(
    method: str, good: float, bad: float, says: str, files: Files
) -> None:
    check_agreement([estimate(files, method, good)], files, numbers=True)
    assert says in refused(estimate(files, method, bad), files)


Array = np.ndarray
Twist = Callable[[Array, dict[str, Any]], Any]
MOTION = "random_motion"


def motion(files: Files, change: Twist = lambda array, note: None, names: slice = slice(None)) -> Path:
    """Write a motion that hardly leaves the posture."""
    settings, layout = files.settings, files.settings.layout
    joints, posture = layout.above_legs, settings.robot.posture_rad
    array = np.array([posture[joint] for joint in joints]) + 1e-3 * np.sin(np.arange(501) / 50.0)[:, None]
    note = {"motion": MOTION, "seed": 101, "rate_hz": 50.0, "part": 101, "variant": 0, "clearance_m": 0.07}
    note |= {"hand_speed_mean_m_s": 0.3, "hand_speed_max_m_s": 0.9}
    change(array, note)
    stem = files.results / "motions" / MOTION / "s101"
    columns = [(f"q_ref.{joint}", "rad", "joint") for joint in joints]
    write_array(stem, array[:, names], columns[names], note)
    return stem.with_suffix(".json")


MOTIONS: dict[str, tuple[Twist, str]] = {
    "motion": (lambda _, note: note.update(motion="other"), "motion: 'other' is not accepted; accepted: 'random_mo"),
    "seed": (lambda _, note: note.update(seed=1001), "seed: 1001 is not accepted; accepted: 101"),
    "rate": (lambda _, note: note.update(rate_hz=100.0), "rate_hz: 100.0 is not accepted; accepted: 50"),
    "part": (lambda _, note: note.update(part="first"), "part: 'first' is not accepted"),
    "variant": (lambda _, note: note.update(variant=7), "variant: 7 is not accepted; accepted: 0 to 3"),
    "clearance": (lambda _, note: note.update(clearance_m=0.001), "clearance_m: 0.001 is not accepted; accepted: 0.0"),
    "speeds": (lambda _, note: note.update(hand_speed_mean_m_s=9.0), "hand_speed_mean_m_s: 9.0 is not"),
    "range": (lambda array, _: array.__setitem__((slice(9, None), 0), 5.0), "q_ref.W1"),
    "a jump": (lambda array, _: array.__setitem__((9, 4), array[9, 4] + 0.9), "speed: 4"),
    "beginning": (lambda array, _: array.__setitem__((slice(None), 4), array[:, 4] + 0.1), "row 0: "),
    "still": (lambda array, _: array.__setitem__((slice(None), 4), array[0, 4]), "q_ref.LA2: every knot: "),
    "clearance in mm": (
        lambda _, note: note.update(clearance_m=69.4),
        "clearance_m: 69.4 is not accepted",
    ),
}


@pytest.mark.parametrize("name", MOTIONS)
def test_a_motion_that_is_not_the_one_of_its_place_is_refused(name: str, files: Files) -> None:
    change, says = MOTIONS[name]
    check_agreement(both_files(motion(files)), files, numbers=True)
    assert says in refused(motion(files, change), files)


def test_a_motion_that_is_too_short_or_lacks_a_joint_is_refused(files: Files) -> None:
    assert "columns: " in refused(motion(files, names=slice(0, 20)), files)
    path = motion(files)
    array, note = read_array(path.with_suffix(""))
    meta = {key: note[key] for key in note if key not in ("rows", "segments", "columns", "footer")}
    columns = [tuple(column.values()) for column in note["columns"]]
    write_array(path.with_suffix(""), array[:100], columns, meta)
    assert "rows: 100 is not accepted; accepted: 501" in refused(path, files)
