"""The names of the columns of every kind of file: who writes a file and who reads it take them from here."""

from collections.abc import Iterable
from dataclasses import dataclass, fields
from itertools import chain

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout

Column = tuple[str, str, str]  # name, unit, frame

# Recordings, residuals and estimates: a column is `<signal>.<joint>`, of a foot `<signal>.<foot>`.
FEET = ("left_foot", "right_foot")
COMMAND = (("step_x", "m"), ("step_y", "m"), ("turn", "rad"), ("duration", "s"), ("foot_height", "m"))  # Table 2
VELOCITY = "v"
DESIRED = "tau_des"
MOTOR = "tau_motor"
SWING = "swing"
CONTACT = "contact"
PUSHED = "pushed"
LANDING = "landing"
PUSH = "push"
FORCE = (
    ("row", "-", "scenario"),
    *((f"force_{axis}", "N", "world") for axis in "xyz"),
)  # of a push on a robot that walks
RANDOM = "tau_random"  # what random torque exploration added to the desired torque
PUSH_TORQUE = "tau_push"  # what pushes alone add to the external torque
EXTERNAL = "tau_ext"  # of a recording: true; of an estimate: estimated
RESIDUAL, EXTERNAL_LP = "r", "tau_ext_lp"  # r of (9), and the true external torque behind the observer's low-pass, (15)
LABEL_LP = "label_lp"  # the external torque by the foot sensors, J^T F, behind the same low-pass
ESTIMATED = "estimated"  # external torque that is estimated, beside a true one
STD = "std"  # standard deviation that an estimate comes with


def named(signal: str, names: Iterable[str]) -> list[str]:
    """Return the columns of a signal of some joints or feet (n,)."""
    return [f"{signal}.{name}" for name in names]


def recording_columns(layout: JointLayout) -> dict[str, list[Column]]:
    """Return field -> columns (name, unit, frame) of a stored recording, in file order; some fields may have none."""
    actuated = layout.actuated
    xyz = "xyz" if layout.virtual else ""
    wxyz = "wxyz" if layout.virtual else ""
    feet = [foot for foot in FEET if foot.removesuffix("_foot") in layout.legs]
    wrench = [(f"force_{axis}", "N") for axis in "xyz"] + [(f"moment_{axis}", "N m") for axis in "xyz"]
    wrenches = dict[str, list[Column]]()
    for foot in FEET:
        own = wrench if foot in feet else []
        wrenches[f"wrench_{foot}"] = [(f"wrench_{foot}.{name}", unit, foot) for name, unit in own]
    base_v = [(f"v.base_{a}", "m/s", "world") for a in xyz] + [(f"v.omega_{a}", "rad/s", "base") for a in xyz]
    base_q = [(f"q.base_{a}", "m", "world") for a in xyz] + [(f"q.quat_{a}", "-", "world") for a in wxyz]
    places = [(j, (layout.unit(j), "world" if i < len(xyz) else "joint")) for i, j in enumerate(layout.names)]
    return {
        "q": base_q + [(f"q.{j}", "rad", "joint") for j in actuated],
        "v": base_v + [(f"{VELOCITY}.{j}", "rad/s", "joint") for j in actuated],
        "acc_base_in_base": [(f"acc.{a}", "m/s^2", "base") for a in xyz],
        "tau_des": [(f"{DESIRED}.{j}", "N m", "joint") for j in actuated],
        "tau_motor": [(f"{MOTOR}.{j}", "N m", "joint") for j in actuated],
        "swing": [(f"{SWING}.{foot}", "-", "plan") for foot in feet],
        "command": [(f"command.{name}", unit, "stance foot") for name, unit in COMMAND if feet],
        "landing": [(f"{LANDING}.{foot}", "s", "plan") for foot in feet],
        EXTERNAL: [(f"{EXTERNAL}.{joint}", *place) for joint, place in places],
        **wrenches,
        "contact": [(f"{CONTACT}.{foot}", "-", "ground") for foot in feet],
        "pushed": [(PUSHED, "-", "scenario")],
        "tau_random": [(f"{RANDOM}.{j}", "N m", "joint") for j in actuated],
        PUSH_TORQUE: [(f"{PUSH_TORQUE}.{joint}", *place) for joint, place in places],
        "push": [(f"{PUSH}.{name}", unit, frame) for name, unit, frame in FORCE if feet],
    }


def recording_width(layout: JointLayout) -> int:
    """Return the number of columns of a stored recording."""
    return sum(map(len, recording_columns(layout).values()))


def foot_of(layout: JointLayout, joint: str) -> str:
    """Return the foot, as named in a recording, of the leg that has a joint.

    Raises:
        ConfigError: the joint belongs to no leg.
    """
    legs = {side: layout.limb(limb) for side, limb in layout.legs.items()}
    for side, joints in legs.items():
        if joint in joints:
            return next(foot for foot in FEET if foot.startswith(side))
    raise ConfigError(not_accepted("leg joint", joint, chain.from_iterable(legs.values())))


def torque_columns(layout: JointLayout, signals: Iterable[str], joints: Iterable[str]) -> list[Column]:
    """Return the columns of torques of some joints, signal by signal, each with the unit and frame of its joint."""
    known = dict(zip(layout.names, recording_columns(layout)[EXTERNAL], strict=True))
    wanted = list(joints)
    columns = list[Column]()
    for signal in signals:
        columns += [(f"{signal}.{joint}", *known[joint][1:]) for joint in wanted]
    return columns


def residual_columns(layout: JointLayout, labelled: bool = False) -> list[Column]:
    """Return name, unit and frame of the columns of a residual file, (2 nv,), or (3 nv,) if foot sensors label it."""
    signals = (RESIDUAL, EXTERNAL_LP, LABEL_LP) if labelled else (RESIDUAL, EXTERNAL_LP)
    return torque_columns(layout, signals, layout.names)


@dataclass(frozen=True)
class Score:
    """One number measured on one run: a row of a file of scores.

    The network seed of a method without networks is 0; on a surrogate robot every method has the seed of the robot's
    networks. `joint` is a joint of the limb, or `avg`, the mean over the limb's joints of this unit; `metric` is a name
    of `metrics.METRICS`, or of a push.
    """

    scenario: str
    level: str
    method: str
    network_seed: int
    test_seed: int
    limb: str
    joint: str
    metric: str
    value: float
    unit: str


@dataclass(frozen=True)
class Epoch:
    """One epoch of a training, counted from 1: a row of metrics.csv.

    Losses are means of (22) over the samples of the training, and over those held out; `validation_rmse` is the mean
    over the joints of their root-mean-square errors [N m], V1..V3 [N]; `gradient_norm` is the mean norm of the gradient
    before the clip; `stride` is the distance between two steps [samples], in training and validation. In the file, the
    errors of the joints follow, in columns of their own: JOINT_ERROR.
    """

    epoch: int
    train_loss: float
    validation_loss: float
    validation_rmse: float
    rate: float
    gradient_norm: float
    stride: int


JOINT_ERROR = "validation_rmse_{}"  # column of metrics.csv with the error of one joint [N m], V1..V3 [N]


@dataclass(frozen=True)
class TrialError:
    """The error of a variant of a method on the development walks of a task: a row of a table of trials.

    `tried` says what is changed, `recipe` how the network learns, `steps` from how many time steps, `seconds` in which
    processor time [s], `state` whether that diverged. `joint` is a joint of the limb, or `avg`; `rmse_nm` is the mean
    over so many walks [N m], `std_nm` their standard deviation. `best` marks the variant of its method with the
    smallest mean error.
    """

    task: str
    method: str
    tried: str
    recipe: str
    network_seed: int
    steps: int | None
    seconds: float | None
    state: str
    validation_loss: float | None
    joint: str
    rmse_nm: float
    std_nm: float | None
    walks: int
    best: int


@dataclass(frozen=True)
class Falls:
    """How often a robot fell with a largest random torque on legs and waist [N m] in so much walking [s]."""

    robot: str
    amplitude_nm: float
    walked_s: float
    falls: int


SCORES = tuple(one.name for one in fields(Score))
EPOCHS = tuple(one.name for one in fields(Epoch))
TRIALS = tuple(one.name for one in fields(TrialError))
FALLS = tuple(one.name for one in fields(Falls))

# Tables. `value`, `low`, `high`: a number and its interval; SPREAD: how many networks and walks it is made of, and its
# standard deviations over them; `runs`: how many runs; `published`: the paper's number. An empty field: there is none.
SPREAD = ("networks", "walks", "std_networks", "std_walks")
RUN = ("scenario", "level", "method")
ERRORS = (*RUN, "joint", "metric", "value", "low", "high", *SPREAD, "unit", "published")
METHODS = (*RUN, "limb", "joint", "metric", "value", "low", "high", *SPREAD, "unit")  # of any test, limb by limb
KINDS = ("method", "quantity", "value", "low", "high", *SPREAD, "unit", "published")
CLAIMS = (
    "claim",
    "statement",
    "score",
    "printed",
    "says",
    "quantity",
    "published",
    "value",
    "low",
    "high",
    *SPREAD,
    "unit",
    "from",
    "to",
    "sign_value",
    "sign_low",
    "sign_high",
    "sign_from",
    "sign_to",
    "size",
    "sign",
    "verdict",
    "without",
    "without_low",
    "without_high",
    "cause",
    "remark",
    "other_reading",
    "beyond_reach",
    "with_zero",
    "with_mob",
    "with_shuffled",
)
HOURLY = ("event", "walks", "method", "hours", "count", "value", "low", "high", "unit")
CLAIMED = ("score", "outcome", "statements", "firsts", "claims")  # `firsts`: statements by their first claim alone
TOLERANCE = ("tolerance", *CLAIMED[1:])  # `tolerance`: a factor, or the rules of the claims
# `outcome` of a count: a verdict, on both or on one of size and sign, all of them, or one of the next line, of what
# fails and of what the paper prints a number of
UNEXPLAINED = "without a cause"
BEYOND = "beyond reach"
PRINTED = "printed"
HELD = "in our interval"
NEAR = "within a factor of 1.5"
# Methods that know nothing of what they are judged on, each in the place of the network of a claim, and the columns of
# `CLAIMS` with the verdicts that they would have: the last one is MOB-Net's own estimate, half a walk late.
MOB_NET = "MOB-Net"
SHUFFLED = f"{MOB_NET}-shuffled"
STAND_INS = {"zero": "with_zero", "MOB": "with_mob", SHUFFLED: "with_shuffled"}
# Outcomes of them: statements that a method could be judged on, and those that would be reproduced
JUDGED_WITH, REPRODUCED_WITH = "judged with {}", "reproduced with {}"
# Verdicts on the size and on the sign of a claim; both together, in the order in which they are shown: what counts
# against us first. A description would be reproduced, but its number tells too little to be counted as that.
INSIDE, OUTSIDE, OPEN = SIZE_VERDICTS = ("inside", "outside", "open")
SAME, OPPOSITE, _ = SIGN_VERDICTS = ("same", "opposite", OPEN)
NOT_REPRODUCED, SIGN_ONLY, OPEN, DESCRIPTION, SIGN_AT_LEAST, REPRODUCED, NOT_MEASURED = VERDICTS = (
    "not reproduced",
    "sign only",
    "open",
    "description",
    "sign at least",
    "reproduced",
    "not measured",
)
# Values of `score` of a claim; PAPER is that of all claims of the paper together
OBSERVER, NETWORKS, NO_NUMBER, OURS = SCORED = ("observer", "networks", "no number", "ours")
PAPER = "paper"
NOT_PRINTED = "not in the paper"  # where a claim of our own is printed
TABLE_01 = (
    "limb",
    "inputs",
    "input_count",
    "target",
    "architecture",
    "parameters",
    "horizon_steps",
    "data",
    "architecture_published",
    "parameters_published",
    "horizon_published",
)
FALLEN = (*FALLS, "per_hour", "low", "high", "chosen")  # of each robot, and of all of them
WHY = (
    "data",
    "method",
    "way",
    "measure",
    "inputs",
    "robot",
    "network",
    "value",
    "low",
    "high",
    "unit",
)  # of a network by its training set and way of learning, of each robot and of all; inputs: those that bring in a hit
FACTORIAL = (
    "part",
    "name",
    "random_torque_nm",
    "pushes",
    "commands",
    "measure",
    "robot",
    "value",
    "low",
    "high",
    "unit",
)  # of a method or a training set, of each robot and of all, then of effects; empty: over all levels of a factor
DATA = ("set", "quantity", "part", "value", "unit", "published")
BIN = ("set", "command", "bin_from", "bin_to", "count")
STEPS = (*BIN, "commanded", "measured", "ratio", "within", "unit")
UNCERTAINTY = ("limb", "joint", "set", "value", "unit", "published", "ratio", "within")
LABEL_ERROR = ("robot", "label", "phase", "joint", "value", "unit")
COVERAGE = (
    "training",
    "scenario",
    "level",
    "measure",
    "joint",
    "block_count",
    "with_rte",
    "without_rte",
    "ratio",
    "low",
    "high",
)
CALIBRATION = (
    "test",
    "level",
    "pushed",
    "method",
    "limb",
    "measure",
    "share",
    "before",
    "before_low",
    "before_high",
    "after",
    "low",
    "high",
    *SPREAD,
    "unit",
)
SAFETY = (
    "case",
    "detector",
    "thresholds",
    "wait_s",
    "measure",
    "value",
    "low",
    "high",
    "walks",
    "touched",
    "unit",
    "published",
)
SENSORLESS = (
    "case",
    "wrench",
    "detector",
    "thresholds",
    "feed_forward",
    "event",
    "hours",
    "events",
    "value",
    "low",
    "high",
    "walks",
    "unit",
)
DETECTION = (
    "level",
    "detector",
    "leg",
    "kind",
    "cell",
    "quantity",
    "value",
    "low",
    "high",
    "count",
    "unit",
    "published",
)  # of collisions: found shares, delays, smallest forces, thresholds and rates of false alarms
LATENCY = ("quantity", "value", "low", "high", "unit")
COMPUTE = ("stage", "quantity", "value", "unit")

# Figures.
COMMANDS = (*BIN, "share", "unit")
PUSH_ERRORS = ("scenario", "method", "push", "measure", "value", "low", "high", *SPREAD, "unit", "published")
JOINT_ERRORS = (*RUN, "joint", "metric", "value", "low", "high", *SPREAD, "unit", "published", "rmse_drawn")
LOSSES = ("measure", "method", "runs", "epoch", "stride", "mean", "low", "high", "unit")
LIMB_ERRORS = ("scenario", "method", "limb", "joint", "rmse_nm", "low", "high", *SPREAD)
TUNED = ("panel", "line", "seconds", *RUN, "joint", "value", "low", "high", *SPREAD, "unit")
PLANES = ("kind", "set", "joint", "from", "to", "torque_from_nm", "torque_to_nm", "share_percent")
SIZES = (
    "panel",
    "base",
    "method",
    "parameters",
    "samples",
    "runs",
    "loss",
    "loss_low",
    "loss_high",
    "rmse_nm",
    "rmse_low_nm",
    "rmse_high_nm",
    "ratio",
    "ratio_low",
    "ratio_high",
)
RESPONSE = ("method", "joint", "frequency_hz", "quantity", "value", "low", "high", *SPREAD, "unit")
DRIFT = ("panel", *RUN, "phase", "step", "share", "low", "high", *SPREAD)
SIGMA = ("panel", "test", "method", "limb", "x", "value", "low", "high", *SPREAD)
RELIABILITY = ("case", "method", "limb", "nominal", "before", "after")
FOREST = ("score", "statement", "claims", "worst", "verdict", "axis", "value", "low", "high", "from", "to")
