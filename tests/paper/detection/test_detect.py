"""The rule `detect` on made-up walks: an estimate that is the truth with noise, and one that sees nothing."""

import tracemalloc

import numpy as np
import pytest
from csv_files import check_golden, read_table
from made_swings import AIR, GROUND, RATE_HZ, swinging, unseen

from experiments.jobs.detect import detect
from experiments.plan.detection import Walk
from experiments.records.collisions import FILES, READINGS
from mobnet.core.columns import residual_columns, torque_columns
from mobnet.core.errors import DataError
from mobnet.core.recording import Recording
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.detection.leg import make_leg, unit_torques
from mobnet.detection.watch import LegSetup
from mobnet.settings.detection import DetectorSettings

POINTS = ("left_foot_front", "left_foot_side", "left_ankle_front", "left_knee_side")
PEAK, LENGTH, LATE = 150.0, 78, 150  # of a hit [N], in samples, and samples after lift-off
NOISE_NM, SWINGS = 0.3, 60
SEED = 7


@pytest.fixture(scope="module")
def section(settings):
    """Detectors of an estimate without and with standard deviations, and of one that sees nothing."""
    numbers = settings.detection.thresholds.model_copy(update={"least_swings": 10, "resamples": 50})
    detectors = {
        "mean": DetectorSettings(method="MOB-Net", signals=("mean",)),
        "OR": DetectorSettings(method="MOB-Net", signals=("mean", "std")),
        "norm": DetectorSettings(method="MOB-Net", signals=("mean",), norm=True),
        "phases": DetectorSettings(method="MOB-Net", signals=("mean",), phases=4),
        "command": DetectorSettings(method="MOB-Net", signals=("mean",), commanded=True),
        "blind": DetectorSettings(method="MOB", signals=("mean",)),
    }
    gate = settings.detection.gate.model_copy(update={"method": "MOB-Net"})
    return settings.detection.model_copy(update={"thresholds": numbers, "detectors": detectors, "gate": gate})


@pytest.fixture(scope="module")
def walks(settings, robot, tmp_path_factory):
    """Two quiet walks; one with a hit of each point, each followed by a free swing; and an empty sweep."""
    folder = tmp_path_factory.mktemp("walks")
    pushes = {f"hit_{point}": settings.pushes["collision_left_foot_front"].model_copy(update={"point": point})
              for point in POINTS}  # fmt: skip
    quiet, hit = {"place_walk": SWINGS, "long_walk": SWINGS}, {"collisions": 2 * len(POINTS), "collision_sweep": 2}
    found = {}
    for number, (scenario, swings) in enumerate({**quiet, **hit}.items()):
        layout, sensed = settings.layout, swinging(settings.layout, swings)
        rows, rng = len(sensed), np.random.default_rng(number)
        push, truth = np.zeros((rows, 4)), np.zeros((rows, layout.nv))
        units = unit_torques(robot, make_leg(robot, "LL"), sensed.q[0], POINTS, -1.0)
        legs = layout.columns(layout.limb("LL"))
        for k in range(len(POINTS) if scenario == "collisions" else 0):
            start = GROUND + 2 * k * (AIR + GROUND) + LATE
            force = PEAK * np.sin(np.pi * np.arange(LENGTH) / LENGTH)
            push[start : start + LENGTH, 0], push[start : start + LENGTH, 1] = k + 1, np.maximum(force, 1e-3)
            truth[start : start + LENGTH, legs] = force[:, None] * units[k]
        stem = folder / scenario / f"s{SEED}"
        write_recording(stem, Recording(sensed, ((0, rows),), RATE_HZ, {}, unseen(layout, rows, push)), layout)
        residual = np.concatenate([truth, truth], axis=1)
        write_array(folder / scenario / "r", residual, residual_columns(layout), {"rate_hz": RATE_HZ})
        slow = np.repeat(rng.normal(size=(rows // 20 + 1, 6)), 20, axis=0)[:rows]
        both = torque_columns(layout, ["tau_ext", "std"], layout.limb("LL"))
        std = 1.0 + 0.05 * rng.uniform(size=(rows, 6)) + 2.0 * (push[:, :1] > 0)
        seeing = np.concatenate([truth[:, legs] + NOISE_NM * slow, std], axis=1)
        write_array(folder / scenario / "seeing", seeing, both, {"rate_hz": RATE_HZ})
        alone = torque_columns(layout, ["tau_ext"], layout.limb("LL"))
        write_array(folder / scenario / "blind", NOISE_NM * slow, alone, {"rate_hz": RATE_HZ})
        names = {"MOB-Net": (folder / scenario / "seeing",), "MOB": (folder / scenario / "blind",)}
        found[scenario] = Walk((stem,), (folder / scenario / "r",), names, pushes if scenario in hit else {})
    return found


@pytest.fixture(scope="module")
def made(section, settings, walks, tmp_path_factory):
    """The files of the rule."""
    out = tmp_path_factory.mktemp("detection")
    left = section.model_copy(update={"legs": ("LL",)})
    detect(left, settings.robot, RATE_HZ, walks, out)
    assert {path.stem for path in out.iterdir()} == set(FILES)
    return out


def test_the_files_of_made_up_walks_are_the_golden_ones(made):
    check_golden(*(made / f"{name}.csv" for name in ("collisions", "detected", "promises", "thresholds")))


def test_collisions_are_those_of_the_recording(made):
    rows = read_table(made / "collisions.csv")
    assert [f"left_{row.link}_{row.direction}" for row in rows] == list(POINTS)
    assert [row.number for row in rows] == [1, 2, 3, 4]
    assert [row.force_n for row in rows] == pytest.approx([PEAK] * 4, rel=0.01)
    assert [row.impulse_ns for row in rows] == pytest.approx([2 / np.pi * PEAK * LENGTH / RATE_HZ] * 4, rel=0.01)
    assert rows[0].start_s == pytest.approx((GROUND + LATE) / RATE_HZ)
    assert rows[0].end_s - rows[0].start_s == pytest.approx(LENGTH / RATE_HZ)
    assert 0 < rows[0].onset_s - rows[0].start_s < 0.006  # 20 of 150 N
    assert rows[0].swing_share == pytest.approx(LATE / AIR, abs=0.01)


@pytest.mark.parametrize("name", ["mean", "OR", "norm", "phases", "command"])
def test_an_estimate_that_sees_finds_and_names_every_collision(made, name):
    rows = [row for row in read_table(made / "detected.csv") if (row.detector, row.kind) == (name, "largest")]
    if name != "OR":  # its standard deviations jump before there is a torque that tells links apart
        assert [f"left_{row.link}_{row.direction}" for row in rows] == list(POINTS)
    for row in rows:
        assert row.ratio > 1.0
        assert 0.004 <= row.delay_s <= 0.05  # five samples, of which the first is that of the contact
        assert row.perfect_s == pytest.approx(row.delay_s, abs=0.005)  # it is the truth with a little noise
        assert 0.0 < row.named_n < PEAK


def test_one_that_sees_nothing_finds_nothing(made, section):
    rows = [row for row in read_table(made / "detected.csv") if row.detector == "blind"]
    assert len(rows) == (len(READINGS) + len(section.thresholds.rates_per_h)) * len(POINTS)
    found = [row for row in rows if row.delay_s is not None]
    assert [row for row in found if row.kind == "collision"] == []
    assert all(row.perfect_s is not None for row in rows)  # at its thresholds the truth would be found


def test_thresholds_are_a_tenth_above_the_largest_and_multiples_of_a_quantile(made, section):
    rows = [row for row in read_table(made / "thresholds.csv") if row.detector == "mean"]
    value = {(row.kind, row.signal): row.value for row in rows}
    promises = {row.kind: row for row in read_table(made / "promises.csv") if row.detector == "mean"}
    assert value["collision", "mean.LL2"] / value["contact", "mean.LL2"] == pytest.approx(
        promises["collision"].factor / promises["contact"].factor, rel=1e-4
    )
    assert 0.1 * NOISE_NM < value["largest", "mean.LL3"] < 4.0 * NOISE_NM
    count = int(np.ceil(section.calibration_share * SWINGS))
    assert {row.swings for row in promises.values()} == {count}
    walked_h = SWINGS * (AIR + GROUND) / RATE_HZ / 3600
    assert promises["collision"].hours == pytest.approx(section.calibration_share * walked_h, rel=0.05)
    phases = [row for row in read_table(made / "thresholds.csv") if (row.detector, row.kind) == ("phases", "largest")]
    assert {row.phase for row in phases} == {1, 2, 3, 4}


def test_free_swings_are_those_that_nothing_pushes(made, section):
    rows = [row for row in read_table(made / "swings.csv") if row.detector == "mean"]
    counts = {key: sum((row.scenario, row.part) == key for row in rows)
              for key in {(row.scenario, row.part) for row in rows}}  # fmt: skip
    first = int(np.ceil(section.calibration_share * SWINGS))
    assert counts == {
        ("place_walk", "calibration"): first, ("place_walk", "held out"): SWINGS - first,
        ("long_walk", "calibration"): first, ("long_walk", "held out"): SWINGS - first,
        ("collisions", "unpushed"): len(POINTS),
    }  # fmt: skip
    place = [row for row in rows if (row.scenario, row.part) == ("place_walk", "calibration")]
    assert max(row.ratio_largest for row in place) == pytest.approx(1 / section.thresholds.margin, rel=1e-4)


def test_of_a_recording_a_leg_keeps_what_detectors_need(section, settings, robot, walks):
    """An hour of walking is tens of recordings: kept whole, they once took four fifths of the memory of the run."""
    setup = LegSetup.of(section, robot, "LL", RATE_HZ)
    walk = walks["long_walk"]
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    (leg,) = setup.recordings(walk.recordings, walk.estimates["MOB-Net"])
    kept = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    assert kept < 1.2 * (leg.command.nbytes + leg.gate.watched.nbytes + leg.gate.phase.nbytes)


def test_curves_find_less_at_higher_thresholds(made):
    rows = [row for row in read_table(made / "curves.csv") if row.detector == "mean"]
    high = [row.found for row in rows if row.factor >= 1.0]
    assert high == sorted(high, reverse=True)
    assert {row.collisions for row in rows} == {len(POINTS)}


def test_a_leg_that_no_method_estimates_is_left_out(section, settings, walks, tmp_path):
    detect(section.model_copy(update={"legs": ("RL",)}), settings.robot, RATE_HZ, walks, tmp_path)
    assert all(read_table(tmp_path / f"{name}.csv") == [] for name in FILES)


def test_a_signal_that_never_changes_is_told(section, settings, walks, tmp_path, write_still):
    long = walks["long_walk"]
    rows = len(swinging(settings.layout, SWINGS))
    still = {**long.estimates, "MOB": (write_still(tmp_path / "still", rows),)}
    spoilt = {**walks, "long_walk": Walk(long.recordings, long.residuals, still, {})}
    with pytest.raises(DataError, match=r"signal mean\.LL4 is always 2\.0; numbers that change are needed"):
        detect(section.model_copy(update={"legs": ("LL",)}), settings.robot, RATE_HZ, spoilt, tmp_path)


@pytest.fixture
def write_still(settings):
    """A function that writes an estimate whose LL4 never changes."""

    def write(stem, rows):
        values = np.random.default_rng(0).normal(size=(rows, 6))
        values[:, 3] = 2.0
        columns = torque_columns(settings.layout, ["tau_ext"], settings.layout.limb("LL"))
        write_array(stem, values, columns, {"rate_hz": RATE_HZ})
        return stem

    return write


def test_detectors_of_a_leg_that_is_never_watched_are_left_out(section, settings, walks, tmp_path, caplog):
    closed = section.gate.model_copy(update={"lift_off_s": 0.4})  # longer than a swing
    left = section.model_copy(update={"legs": ("LL",), "gate": closed})
    detect(left, settings.robot, RATE_HZ, walks, tmp_path)
    assert read_table(tmp_path / "thresholds.csv") == []
    assert len(read_table(tmp_path / "collisions.csv")) == len(POINTS)
    assert "LL, mean is left out: the leg is watched in none of the swings that calibrate" in caplog.text
