"""The columns of tables and of the data of figures: who writes a file and who reads it take their names from here."""

from experiments.records.falls import FALLS

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
TEN_FIRST = (
    *("place", "claim", "statement", "published", "value", "low", "high", "unit"),
    *("size", "sign", "verdict", "picture"),
)
CLAIMED = ("score", "outcome", "statements", "firsts", "claims")  # `firsts`: statements by their first claim alone
TOLERANCE = ("tolerance", *CLAIMED[1:])  # `tolerance`: a factor, or the rules of the claims
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
