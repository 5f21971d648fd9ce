"""What the columns of a robot's log mean, `./reproduce observe --map FILE`."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from mobnet.formats.base import RateHz, Real, Section, Some, Text, TorqueKind, Vector3

Unit = Literal[
    "rad",
    "deg",
    "rad/s",
    "deg/s",
    "rpm",
    "N m",
    "mN m",
    "kN m",
    "A",
    "m",
    "mm",
    "m/s",
    "m/s^2",
    "g",
    "N",
    "kN",
    "s",
    "ms",
    "us",
    "ns",
    "-",
]
Sign = Literal[-1, 1]


class Clock(Section):
    """The clock of a log.

    Attributes:
        column: of a table, in which all columns have one clock.
        unit: of that column.
        stamp: of messages, which have times of their own: the stamps in their headers, or the times at which they were
            recorded; the latter also where they have no header or it is zero.
    """

    column: Text = "time"
    unit: Literal["s", "ms", "us", "ns"] = "s"
    stamp: Literal["header", "recorded"] = "header"


def _of_unit_length(quat: tuple[float, ...]) -> tuple[float, ...]:
    """Check the length of a quaternion."""
    if abs(sum(part * part for part in quat) - 1.0) > 1e-3:
        raise ValueError("accepted: four numbers w x y z of unit length")
    return quat


class Signal(Section):
    """One signal: the columns that hold it, in the order of the robot's table, and how they become SI units.

    A value becomes `sign` x (`scale` x value in `unit` - `offset`); scale, sign and offset are one number for all
    columns or one for each.

    Attributes:
        columns: names in the log; of joints in motor order, of a vector x y z, of a wrench force and then moment. One
            name alone stands for the columns below it: NAME.JOINT, NAME.x and so on, or NAME.0 and so on; or, with a *,
            for those with names of joints or numbers in its place.
        unit: unit of the columns, of which `scale` is one: a current in A becomes a torque by a scale in N m/A.
        offset: what is subtracted, SI units.
        delay_s: by how much the signal is late in the log [s]; it is brought forward.
        order: of a quaternion.
        gravity: whether an accelerometer's numbers contain gravity, as specific force does.
        frame: axes of the base's linear velocity.
    """

    columns: Some[Text]
    unit: Unit | None = None
    sign: Sign | tuple[Sign, ...] = 1
    scale: Real | tuple[Real, ...] = 1.0
    offset: Real | tuple[Real, ...] = 0.0
    delay_s: Annotated[Real, Field(ge=-1, le=1)] = 0.0
    order: Literal["wxyz", "xyzw"] = "wxyz"
    gravity: Literal["included", "removed"] = "included"
    frame: Literal["world", "base"] = "world"


class Tool(Signal):
    """A force and torque sensor at the end effector: what acts on the tool beyond it, without the tool's own weight.

    Attributes:
        body: body of the robot's table that carries it.
        pos: place in the body's frame [m].
        quat: axes of the sensor in those of the body, w x y z.
    """

    body: Text
    pos: Vector3 = (0.0, 0.0, 0.0)
    quat: Annotated[tuple[Real, Real, Real, Real], AfterValidator(_of_unit_length)] = (1.0, 0.0, 0.0, 0.0)


class LogMap(Section):
    """What the columns of a log mean. Signals that the robot does not have are left out.

    Attributes:
        clock: the clock of all columns, or which clock of messages counts.
        joints: names of the joints in the log, in motor order, if they are others than those of the robot's table.
        rate_hz: samples per second of the recording that is made; that of the log where it is not given [Hz].
        torque: whether torques are samples at the ticks or means over the intervals before them.
        position: place of the base in the world; the observer does not need it.
        quaternion, velocity, omega, acc: of the base: orientation, linear velocity, angular velocity in base axes, and
            specific force of the inertial sensor in base axes.
        q, v, tau_motor: positions, velocities and torques of the motors on the side of the joints.
        left_foot, right_foot: force and moment on the foot's sensor, in the foot's axes.
        tool: force and moment on the sensor at an end effector, in the sensor's axes; labels for `./reproduce learn`.
        swing, landing: per foot, left and then right, as `docs/data.md` says.
    """

    clock: Clock = Clock()
    joints: Some[Text] | None = None
    rate_hz: RateHz | None = None
    torque: TorqueKind = "sample"
    q: Signal
    v: Signal
    tau_motor: Signal
    position: Signal | None = None
    quaternion: Signal | None = None
    velocity: Signal | None = None
    omega: Signal | None = None
    acc: Signal | None = None
    left_foot: Signal | None = None
    right_foot: Signal | None = None
    tool: Tool | None = None
    swing: Signal | None = None
    landing: Signal | None = None
