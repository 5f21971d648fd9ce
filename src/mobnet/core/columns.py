"""The names of the columns of every kind of file: who writes a file and who reads it take them from here."""

from __future__ import annotations

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class Score:
    """One number measured on one run: a row of a file of scores.

    Attributes:
        scenario: the test.
        level: uncertainty level of section 5.1.
        method: estimator, a row of the configuration's methods.
        network_seed: seed of the networks; 0 for a method without any.
        test_seed: seed of the test recording.
        limb: limb of section 4.1.
        joint: a joint of the limb, or `avg`, the mean over the limb's joints of this unit.
        metric: a name of `metrics.METRICS`, or of a push.
        value: the number [unit].
        unit: unit of the number.
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
    """One epoch of a training: a row of metrics.csv.

    Attributes:
        epoch: counted from 1.
        train_loss: mean of (22) over the training samples [-].
        validation_loss: mean of (22) over the samples held out [-].
        validation_rmse: mean over the joints of their root-mean-square errors [N m], V1..V3 [N].
        rate: learning rate.
        gradient_norm: mean norm of the gradient before the clip.
    """

    epoch: int
    train_loss: float
    validation_loss: float
    validation_rmse: float
    rate: float
    gradient_norm: float


SCORES, EPOCHS = (tuple(field.name for field in fields(kind)) for kind in (Score, Epoch))

# Tables. `value`, `low`, `high`: a number and its interval; `runs`, `seed_count` and `run_count`: how many runs it is
# made of; `published`: the paper's number. An empty field: there is no such number.
RUN = ("scenario", "level", "method")
ERRORS = (*RUN, "joint", "seed_count", "metric", "value", "low", "high", "unit", "published")
METHODS = (*RUN, "limb", "joint", "metric", "runs", "value", "low", "high", "unit")
KINDS = ("method", "quantity", "value", "low", "high", "unit", "published")
CLAIMS = (
    "claim", "printed", "says", "published", "value", "low", "high", "seed_count", "unit", "differs", "rule", "verdict",
    "cause",
)  # fmt: skip
TABLE_01 = (
    "limb", "inputs", "input_count", "target", "architecture", "parameters", "horizon_steps", "data",
    "architecture_published", "parameters_published", "horizon_published",
)  # fmt: skip
DATA = ("set", "quantity", "part", "value", "unit", "published")
BIN = ("set", "command", "bin_from", "bin_to", "count")
STEPS = (*BIN, "commanded", "measured", "ratio", "within", "unit")
UNCERTAINTY = ("limb", "joint", "set", "value", "unit", "published", "ratio", "within")
COVERAGE = (
    "scenario", "level", "measure", "joint", "block_count", "with_rte", "without_rte", "ratio", "low", "high",
)  # fmt: skip
CALIBRATION = (
    "test", "level", "pushed", "method", "limb", "measure", "share", "run_count",
    "before", "before_low", "before_high", "after", "low", "high", "unit",
)  # fmt: skip
COMPUTE = ("stage", "quantity", "value", "unit")

# Figures.
COMMANDS = (*BIN, "share", "unit")
PUSH_ERRORS = ("scenario", "method", "push", "runs", "rmse_nm", "low", "high", "published")
LOSSES = ("measure", "method", "runs", "epoch", "mean", "low", "high")
LIMB_ERRORS = ("scenario", "method", "limb", "joint", "runs", "rmse_nm", "low", "high")
DOTS = ("kind", "set", "joint", "velocity_rad_s", "torque_nm")
SIZES = (
    "panel", "base", "method", "parameters", "samples", "runs",
    "loss", "loss_low", "loss_high", "rmse_nm", "rmse_low_nm", "rmse_high_nm",
)  # fmt: skip
RELIABILITY = ("panel", "method", "limb", "nominal", "before", "after")
