"""Where collisions of legs meet them, by estimates and by the true torque, and by guesses from the named link or none.

What is named is compared with the point at which the scenario pushes, which need not lie on a solid of the table, and
with the force behind the low-pass that delays every estimate (D22).
"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from experiments.evaluation.number.frames import CONTACTS
from experiments.evaluation.number.rows import read_detections
from experiments.jobs.collisions import Hit, hits_of
from experiments.plan.detection import Detections
from experiments.plan.runs import Run
from experiments.records.collisions import Detected
from experiments.settings.detection_tables import ContactLine, ContactPoints
from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL_LP, PUSH, named
from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import read_array
from mobnet.detection.contact import ContactLocator
from mobnet.detection.watch import read_estimate
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import ContactNumbers
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.description import RobotDescription
from mobnet.settings.data import Push
from mobnet.settings.detection import ContactPoint

NAMED, NOTHING = "middle of the named link", "middle of the leg"  # guesses, which name no force
ERRORS = ("error_x_m", "error_y_m", "error_z_m")
FORCE = named(PUSH, ("force_x", "force_y", "force_z"))
Finders = Mapping[tuple[str, bool], ContactLocator]  # leg, and whether its torques are taken alone
Alarms = Mapping[tuple[str, int], Detected]  # leg and number of a collision


class CollisionWalk(NamedTuple):
    """A recording with collisions: positions (T, nq), estimates by method, forces behind the low-pass (T, 3) [N].

    The true torque behind the low-pass is an estimate too, that of the method None.
    """

    q: Array
    rate_hz: float
    estimates: Mapping[str | None, Estimate]
    force: Array


def contacts_of(
    settings: ContactPoints, numbers: ContactPoint, robot: RobotDescription, gain_hz: float,
    pushes: Mapping[str, Push], runs: Sequence[Run], detections: Detections,
) -> pd.DataFrame:  # fmt: skip
    """Return what lines of the table say of collisions that are hard enough and that the detector finds: CONTACTS.

    Args:
        settings: the table.
        numbers: section `contact_point`.
        robot: the robot.
        gain_hz: gain of the observer, K_0 of (7) [1/s].
        pushes: those of the scenario, in their order.
        runs: of the table's methods.
        detections: files of the robots' detectors.

    Raises:
        DataError: a file is missing or damaged, or a method does not give what a line takes.
    """
    joints = robot.layout.limbs(settings.limbs)
    finders: dict[tuple[str, bool], ContactLocator] = {}
    for leg in settings.legs:
        finders[leg, False] = ContactLocator.of(as_plain(numbers, ContactNumbers), robot, leg, joints)
        # The hit leg alone, too: its torques are fewer than the unknowns of a hit above the foot
        # (docs/notes/contact.md).
        finders[leg, True] = ContactLocator.of(as_plain(numbers, ContactNumbers), robot, leg, robot.layout.limb(leg))
    rows: list[dict[str, object]] = []
    for recording in dict.fromkeys(run.recording for run in runs):
        walked = _walked(robot, joints, gain_hz, [run for run in runs if run.recording == recording])
        alarms = _alarms(settings, detections, recording)
        count = dict.fromkeys(settings.legs, 0)
        for hit in hits_of(recording, pushes, robot.layout):
            count[hit.leg] = count.get(hit.leg, 0) + 1
            # Files of detectors number the collisions of each leg by themselves.
            alarm = alarms.get((hit.leg, count[hit.leg]))
            if alarm is not None and hit.force.max() >= settings.least_n:
                rows += _found(settings, finders, walked, hit, pushes[hit.name].point or "", alarm)
    return pd.DataFrame(rows, columns=list(CONTACTS)).astype({name: kind for name, (kind, _, _) in CONTACTS.items()})


def _alarms(settings: ContactPoints, detections: Detections, recording: Path) -> Alarms:
    """Return what the detector says of the collisions of some legs in a recording that it finds."""
    level = recording.parent.name
    seed = int(recording.name.removeprefix("s"))
    asked = settings.scenario, settings.detector, settings.kind, seed
    alarms: dict[tuple[str, int], Detected] = {}
    for row in read_detections(detections[level]["detected"], "detected"):
        if (row.scenario, row.detector, row.kind, row.seed) == asked and row.delay_s is not None:
            alarms[row.leg, row.number] = row
    return alarms


def _walked(robot: RobotDescription, joints: Sequence[str], gain_hz: float, runs: Sequence[Run]) -> CollisionWalk:
    """Read a recording, its truth and what its runs estimate of some joints."""
    read = read_sensed(runs[0].recording, robot.layout)
    estimates: dict[str | None, Estimate] = {
        None: Estimate(read_array(runs[0].residual, named(EXTERNAL_LP, joints))[0])
    }
    for run in runs:
        if (estimate := read_estimate(run.estimate, joints)) is None:
            raise DataError(f"{run.estimate}: some of {', '.join(joints)} are not estimated; accepted: all of them")
        estimates[run.method] = estimate
    force = low_pass(read_array(runs[0].recording, FORCE)[0], gain_hz, read.rate_hz)
    return CollisionWalk(read.sensed.q, read.rate_hz, estimates, force)


def _found(
    settings: ContactPoints, finders: Finders, walked: CollisionWalk, hit: Hit, point: str, alarm: Detected
) -> Iterator[dict[str, object]]:  # fmt: skip
    """Yield what each line says of a collision at a point of the robot, and then the guesses, as rows of CONTACTS."""
    cell = f"{hit.link} {hit.direction}"
    finder = finders[hit.leg, False]
    points = {row.name: row for row in finder.robot.points}
    feet = finder.robot.feet.values()
    true = points[point]
    standing = [foot.body for foot in feet if foot.limb != hit.leg]

    def row_after(wait_s: float) -> int:
        later = round(((alarm.delay_s or 0.0) + wait_s) * walked.rate_hz)
        return min(hit.rows.start + later, len(walked.force) - 1)

    def error_of(place: Array, row: int) -> dict[str, float]:
        axes, origin = finder.place(walked.q[row], true.body)
        return dict(zip(ERRORS, (axes.T @ (place - origin) - true.pos).tolist(), strict=True))

    for title, line in settings.lines.items():
        row = row_after(settings.after_s if line.after_s is None else line.after_s)
        locator = finders[hit.leg, line.alone]
        # The base feels the unknown wrench of the ground on the standing foot, too (docs/notes/contact.md), a leg alone
        # does not.
        contact = locator.locate(
            walked.q[row], *_torques(walked, line, locator, finder, row), () if line.alone else standing
        )
        if contact is not None:
            force, angle_deg = _compared(contact.force, walked.force[row])
            said = {"spread_m": contact.spread_m, "force": force, "angle_deg": angle_deg}
            yield {"line": title, "cell": cell, **error_of(contact.place, row), **said}
    row = row_after(settings.after_s)
    named_body = points[f"{point.split('_')[0]}_{alarm.link}_{alarm.direction}"].body
    guesses = {NAMED: [named_body], NOTHING: {shape.body for shape in finder.surface.shapes}}
    for title, bodies in guesses.items():
        yield {"line": title, "cell": cell, **error_of(_middle(finder, walked.q[row], bodies), row)}


def _torques(
    walked: CollisionWalk, line: ContactLine, locator: ContactLocator, whole: ContactLocator, row: int
) -> tuple[Array, Array]:  # fmt: skip
    """Return the torques of a finder's joints in a row by a line, and the standard deviations of their errors (n,).

    Estimates hold the joints of the whole finder.
    """
    estimate = walked.estimates[line.method]
    columns = [whole.joints.index(joint) for joint in locator.joints]
    if line.std is not None:
        std = np.array([line.std[locator.robot.layout.unit(joint) == "N"] for joint in locator.joints])
    elif estimate.std is not None:
        std = estimate.std[row, columns]
    else:
        raise DataError(f"contact_points: {line.method} gives no standard deviation; accepted: a line with `std`")
    return estimate.tau_ext[row, columns].astype(np.float64), std


def _compared(force: Array, true: Array) -> tuple[float, float]:
    """Return the size of a force (3,) over that of the true one, less 1 [-], and the angle between them [deg]."""
    size = float(np.linalg.norm(force))
    true_size = float(np.linalg.norm(true))
    cosine = np.clip(force @ true / max(size * true_size, 1e-9), -1.0, 1.0)
    return size / max(true_size, 1e-9) - 1.0, float(np.rad2deg(np.arccos(cosine)))


def _middle(finder: ContactLocator, q: Array, bodies: Collection[str]) -> Array:
    """Return the middle of the surface of some bodies in the world (3,) [m], at a position q (nq,)."""
    surface = finder.surface
    whole = np.zeros(3)
    total = 0.0
    for k, shape in enumerate(surface.shapes):
        if shape.body in bodies:
            axes, origin = finder.place(q, shape.body)
            patch = surface.patch.only(surface.shape == k)
            whole += patch.area @ (patch.points @ axes.T + origin)
            total += patch.area.sum()
    return whole / total
