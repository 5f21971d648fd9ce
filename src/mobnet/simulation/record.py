"""From a scenario to a Recording: episodes until enough samples are kept; a fall ends one and the next begins."""

import logging
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.control.upper_body import UpperBody
from mobnet.core.code import provenance
from mobnet.core.columns import recording_columns
from mobnet.core.errors import SimulationError
from mobnet.core.store import array_writer, read_array
from mobnet.settings.data import RecordingSettings
from mobnet.settings.walking import WalkSettings
from mobnet.simulation.self_collision import Clearance
from mobnet.simulation.simulator import Simulator

log = logging.getLogger(__name__)
Rows = NDArray[np.float32]
REPORT_WALL_S = 5.0  # between two lines of progress
FALLS_MAX = 20  # more falls in one recording mean that the setting cannot be walked


@dataclass
class RecordingCourse:
    """How a recording went so far."""

    # kept stretches (start, end) of samples, each contiguous in time
    segments: list[tuple[int, int]] = field(default_factory=list)
    terrains: list[str] = field(default_factory=list)  # terrain of each stretch
    falls: int = 0  # how often the robot fell


class CollisionWatch:
    """Looks for self-collision in some of the samples that come in (section 4.3: it does not occur)."""

    def __init__(self, clearance: Clearance, every: int, nq: int) -> None:
        """Look at each `every`-th sample of a chunk, at its first nq columns."""
        self.clearance = clearance
        self.every = every
        self.nq = nq
        self.nearest = clearance.reach
        self.collisions = 0

    def look(self, rows: Rows) -> None:
        """Note the smallest distance [m] in some of the samples (n, C), and in how many of them solids overlap."""
        distances = self.clearance.nearest(rows[:: self.every, : self.nq].astype(np.float64))
        self.nearest = min(self.nearest, float(distances.min()))
        self.collisions += int((distances < 0.0).sum())


def collect(settings: WalkSettings, seed: int, duration_s: float, out: Path, motion: Path | None = None) -> None:
    """Simulate a scenario and write the Recording `out`.parquet and .json (section 4.3).

    A fall ends a segment; what came in the last seconds before it is dropped and a new episode goes on until
    `duration_s` [s] are kept. Samples are written while the robot walks: memory does not grow with the duration.
    Without a motion the upper body holds its posture.

    Raises:
        SimulationError: the robot keeps falling.
    """
    started = time.perf_counter()
    simulator = Simulator(settings, seed, read_motion(motion) if motion else None)
    layout = simulator.robot.layout
    rate = settings.rates.data_hz
    samples = round(duration_s * rate)
    columns = list(chain.from_iterable(recording_columns(layout).values()))
    watch = CollisionWatch(Clearance(simulator.robot), round(rate / settings.recording.clearance_hz), layout.nq)
    with array_writer(out, columns) as writer:

        def keep(rows: Rows) -> None:
            writer.append(rows)
            watch.look(rows)

        course = record(simulator, samples, settings.recording, rate, keep)
        meta = {
            "rate_hz": rate,
            "scenario": settings.scenario_name,
            "level": settings.level_name,
            "seed": seed,
            "falls": course.falls,
            "terrains": course.terrains,
            "clearance_min_m": round(watch.nearest, 4),
            "self_collisions": watch.collisions,
            "provenance": provenance(),
        }
        writer.close(meta, course.segments)
    speed = duration_s / (time.perf_counter() - started)
    log.info("%s: %d falls, simulated at %.1f times real time", out.name, course.falls, speed)


def read_motion(stem: Path) -> UpperBody:
    """Read the knots of an upper body's motion, written by `make_motion`."""
    knots, meta = read_array(stem)
    return UpperBody(np.asarray(knots, dtype=np.float64), float(meta["rate_hz"]), np.zeros(1))


def record(
    simulator: Simulator, samples: int, settings: RecordingSettings, rate_hz: float, keep: Callable[[Rows], None]
) -> RecordingCourse:
    """Walk until `samples` are kept, handing them on in order, rows (n, C); return how it went.

    Raises:
        SimulationError: the robot keeps falling.
    """
    course = RecordingCourse()
    end = 0
    reported = time.perf_counter()
    while end < samples:
        begin = end
        longest = min(samples - begin, round(settings.episode_s * rate_hz))
        for rows in _episode(simulator, longest, settings, rate_hz, begin, course):
            keep(rows)
            end += len(rows)
            if time.perf_counter() - reported > REPORT_WALL_S:
                log.info("%d of %d s simulated", end / rate_hz, samples / rate_hz)
                reported = time.perf_counter()
        if end > begin:
            course.segments.append((begin, end))
            course.terrains.append(simulator.setting.terrain)
        if course.falls > FALLS_MAX:
            raise SimulationError(f"{course.falls} falls in {end / rate_hz:.0f} s: this setting cannot be walked")
    return course


def _episode(
    simulator: Simulator, longest: int, settings: RecordingSettings, rate_hz: float, begin: int, course: RecordingCourse
) -> Iterator[Rows]:
    """Yield the samples worth keeping of an episode of at most `longest` samples; count its fall.

    The last seconds are held back until it is known that no fall follows them.
    """
    chunk = round(settings.chunk_s * rate_hz)
    settle = round(settings.settle_s * rate_hz)
    dropped = round(settings.dropped_before_fall_s * rate_hz)
    simulator.start(begin / rate_hz)
    width = simulator.width
    fallen = simulator.run(np.zeros((settle, width), dtype=np.float32)) < settle
    waiting: deque[Rows] = deque()
    walked = 0
    while walked < longest and not fallen:
        rows = np.zeros((min(chunk, longest - walked), width), dtype=np.float32)
        done = simulator.run(rows)
        fallen = done < len(rows)
        walked += done
        waiting.append(rows[:done])
        while not fallen and sum(map(len, waiting)) - len(waiting[0]) >= dropped:
            yield waiting.popleft()
    if fallen:
        course.falls += 1
        log.info("fall %d: the last %g s before it are dropped", course.falls, settings.dropped_before_fall_s)
    rest = np.concatenate(waiting) if waiting else np.zeros((0, width), dtype=np.float32)
    rest = rest[: max(0, len(rest) - dropped)] if fallen else rest
    if len(rest):
        yield rest
