"""Files of rows as pandas frames, checked as they are read: the columns of each with type, unit and meaning.

A frame is tidy: a row is one observation, and other columns say what its numbers are of. docs/frames.md has these
columns for readers. A missing number is NaN, as in pandas, where the rows of a file have None.
"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from experiments.evaluation.number.rows import Field, read_detections
from experiments.evaluation.number.rows import read_scores as score_rows
from experiments.evaluation.number.rows import read_trials as trial_rows
from mobnet.core.errors import DataError, not_accepted, refuse_lines
from mobnet.core.rows import parse_field, read_texts

TEXT, WHOLE, REAL = "str", "int64", "float64"
FLAG = "bool"
HINTS = {TEXT: str, WHOLE: int, REAL: float}  # type of a column -> that of a field of a file
Schema = Mapping[str, tuple[str, str, str]]  # column -> its type, unit and meaning

SCORES: Schema = {
    "scenario": (TEXT, "", "the test"),
    "level": (TEXT, "", "the plant: a level of uncertainty, or `robots`"),
    "method": (TEXT, "", "what estimates"),
    "network_seed": (WHOLE, "", "the network; 0 without one; on a robot that of the robot"),
    "test_seed": (WHOLE, "", "the walk"),
    "limb": (TEXT, "", "the limb"),
    "joint": (TEXT, "", "a joint of it, or `avg`, the mean over those of one unit"),
    "metric": (TEXT, "", "what is measured, such as `rmse`"),
    "value": (REAL, "column `unit`", "the number of the run"),
    "unit": (TEXT, "", "its unit"),
}
COLLISIONS: Schema = {
    "scenario": (TEXT, "", "the walks"),
    "seed": (WHOLE, "", "the walk"),
    "number": (WHOLE, "", "the collision of a walk, counted from 1"),
    "push": (TEXT, "", "the push"),
    "leg": (TEXT, "", "the leg that is hit"),
    "link": (TEXT, "", "the link that is hit"),
    "direction": (TEXT, "", "from where"),
    "start_s": (REAL, "s", "when it begins"),
    "onset_s": (REAL, "s", "when its force exceeds `detection.onset_n`"),
    "end_s": (REAL, "s", "when it ends"),
    "force_n": (REAL, "N", "its largest force"),
    "impulse_ns": (REAL, "N s", "its impulse"),
    "swing_share": (REAL, "-", "share of the swing at which it begins"),
}
DETECTED: Schema = {
    "scenario": (TEXT, "", "the walks"),
    "seed": (WHOLE, "", "the walk"),
    "leg": (TEXT, "", "the leg that is hit"),
    "number": (WHOLE, "", "the collision of a walk, counted from 1"),
    "detector": (TEXT, "", "the detector"),
    "kind": (TEXT, "", "the rule of its thresholds"),
    "ratio": (REAL, "-", "its largest signal over the threshold"),
    "delay_s": (REAL, "s", "time from the beginning to the alarm; missing where it finds nothing"),
    "perfect_s": (REAL, "s", "that of an estimate without error at the same thresholds"),
    "signal": (TEXT, "", "what crosses its threshold first"),
    "link": (TEXT, "", "the link that it names; empty where it finds nothing, as the next one"),
    "direction": (TEXT, "", "from where, as it says"),
    "named_n": (REAL, "N", "the force that it names"),
}
HIT = ["scenario", "seed", "leg", "number"]  # what names a collision of a robot
NAMED = {"link": "named_link", "direction": "named_direction"}  # columns of DETECTED -> their names among hits
HITS: Schema = {
    "robot": (TEXT, "", "the robot, or the level of the plant"),
    **{NAMED.get(name, name): described for name, described in DETECTED.items()},
    **{name: described for name, described in COLLISIONS.items() if name not in HIT},
    "found": (FLAG, "", "whether the detector has an alarm"),
}
SWINGS: Schema = {
    "detector": (TEXT, "", "the detector"),
    "leg": (TEXT, "", "the leg that swings"),
    "scenario": (TEXT, "", "the walks"),
    "part": (TEXT, "", "`calibration`, `held out`, or `unpushed`: between the collisions of a walk"),
    "terrain": (TEXT, "", "the ground"),
    "seed": (WHOLE, "", "the walk"),
    "number": (WHOLE, "", "the swing of a walk, counted from 1"),
    "ratio": (REAL, "-", "largest signal over the threshold for one false alarm an hour"),
    "ratio_largest": (REAL, "-", "over the original's threshold, from walking in place"),
    "ratio_walking": (REAL, "-", "over that from random walking"),
}
PROMISES: Schema = {
    "detector": (TEXT, "", "the detector"),
    "leg": (TEXT, "", "the leg"),
    "kind": (TEXT, "", "the rule of its thresholds"),
    "swings": (WHOLE, "", "how many swings calibrated them"),
    "hours": (REAL, "h", "of walking"),
    "factor": (REAL, "-", "multiple of the scales of its signals"),
    "rate_per_h": (REAL, "1/h", "false alarms that are promised"),
    "low": (REAL, "1/h", "the ends of their interval"),
    "high": (REAL, "1/h", ""),
}
THRESHOLDS: Schema = {
    "detector": (TEXT, "", "the detector"),
    "leg": (TEXT, "", "the leg"),
    "kind": (TEXT, "", "the rule of its thresholds"),
    "signal": (TEXT, "", "the signal"),
    "phase": (WHOLE, "", "the phase of the swing, counted from 1"),
    "value": (REAL, "column `unit`", "the threshold"),
    "unit": (TEXT, "", "its unit"),
}
CURVES: Schema = {
    "detector": (TEXT, "", "the detector"),
    "leg": (TEXT, "", "the leg"),
    "factor": (REAL, "-", "multiple of its thresholds"),
    "found": (WHOLE, "", "collisions that it finds at it"),
    "collisions": (WHOLE, "", "how many there are"),
    "delay_sum_s": (REAL, "s", "sum of the delays of those that it finds"),
}
TRIALS: Schema = {
    "case": (TEXT, "", "what is walked, a key of `reaction.cases`"),
    "level": (TEXT, "", "the robot"),
    "seed": (WHOLE, "", "the walk"),
    "detector": (TEXT, "", "the detector; `none` where the robot does not react"),
    "rule": (TEXT, "", "the rule of its thresholds"),
    "wait_s": (REAL, "s", "how long the reaction waits after an alarm"),
    "wrench": (TEXT, "", "of the feet that the controller gets: `sensed` or `estimated`"),
    "feed_forward": (REAL, "-", "share of the learned torque that motors make up for"),
    "walked_s": (REAL, "s", "how long the robot walks as told, watched"),
    "velocity_rmse_m_s": (REAL, "m/s", "error of the base's velocity in this time"),
    "tracking_rmse_rad": (REAL, "rad", "error of the joints of the leg that swings"),
    "power_w": (REAL, "W", "mean power of the motors"),
    "contact_s": (REAL, "s", "the first contact; missing without one, as is all of what did not happen"),
    "in_swing": (REAL, "", "1 if the contact began in mid-swing, else 0; missing where no leg is in front"),
    "alarm_s": (REAL, "s", "the alarm"),
    "limb": (TEXT, "", "the limb that was watched"),
    "reacted_s": (REAL, "s", "the reaction"),
    "angle_deg": (REAL, "deg", "angle between the reaction and the force of the obstacle"),
    "base_angle_deg": (REAL, "deg", "the same of the unexpected force on the base, (24)"),
    "first_peak_n": (REAL, "N", "largest force of the first contact"),
    "first_impulse_ns": (REAL, "N s", "its impulse"),
    "peak_n": (REAL, "N", "largest force"),
    "impulse_ns": (REAL, "N s", "impulse of all contacts"),
    "contacts": (WHOLE, "", "number of contacts"),
    "fell_s": (REAL, "s", "the fall"),
    "stopped": (WHOLE, "", "1 if the robot stands at the end"),
}
CONTACTS: Schema = {
    "line": (TEXT, "", "what says where: an estimate, the true torque or a guess"),
    "cell": (TEXT, "", "the link that is hit, and from where"),
    "error_x_m": (REAL, "m", "from the true point to the named one, in the axes of the body that is hit"),
    "error_y_m": (REAL, "m", ""),
    "error_z_m": (REAL, "m", ""),
    "spread_m": (REAL, "m", "the error that it expects itself; missing of a guess, as the next two"),
    "force": (REAL, "-", "size of the force over that of the true one, less 1"),
    "angle_deg": (REAL, "deg", "angle between the two"),
}
NETWORKS: Schema = {
    "method": (TEXT, "", "what learned"),
    "seed": (WHOLE, "", "its seed; on a robot that of the robot"),
    "parameters": (WHOLE, "", "how many numbers are learned"),
    "samples": (WHOLE, "", "samples learned from, without those held out"),
    "diverged": (FLAG, "", "whether the training was stopped as its loss grew"),
    "stride": (REAL, "", "samples from one step to the next in the epoch that is kept"),
    "validation_loss": (
        REAL,
        "-",
        "loss (22) of the epoch that validated best and is kept; missing without one",
    ),
    "validation_rmse": (REAL, "N m", "its RMSE, the mean over the joints"),
    "windows_loss": (REAL, "-", "its loss if the network starts from a zero state a window before every sample"),
    "last_train_loss": (REAL, "-", "loss in training of the last epoch"),
    "last_validation_loss": (REAL, "-", "loss in validation of the last epoch"),
}
TRAININGS: Schema = {
    "method": (TEXT, "", "what learned"),
    "seed": (WHOLE, "", "its seed; on a robot that of the robot"),
    "diverged": (FLAG, "", "whether the training was stopped as its loss grew"),
    "epoch": (WHOLE, "", "the epoch, counted from 1"),
    "train_loss": (REAL, "-", "loss (22) in training"),
    "validation_loss": (REAL, "-", "on the data held out"),
    "validation_rmse": (REAL, "N m", "RMSE there, the mean over the joints; N of the base's forces"),
    "rate": (REAL, "-", "learning rate"),
    "gradient_norm": (REAL, "-", "mean norm of the gradient before the clip"),
    "stride": (WHOLE, "", "samples from one step to the next"),
}
FALLS: Schema = {
    "robot": (TEXT, "", "the robot"),
    "amplitude_nm": (REAL, "N m", "largest random torque on legs and waist"),
    "walked_s": (REAL, "s", "how long it walked with it"),
    "falls": (WHOLE, "", "how often it fell"),
}
TRUSTED: Schema = {
    "scenario": (TEXT, "", "the test, or `validation`: held-out data of trainings"),
    "level": (TEXT, "", "the plant"),
    "pushed": (TEXT, "", "the joint that is pushed, if samples around pushes alone count; else empty"),
    "method": (TEXT, "", "what estimates"),
    "limb": (TEXT, "", "the limb"),
    "joint": (TEXT, "", "`avg`: all numbers are means over the joints of the limb that have the unit"),
    "unit": (TEXT, "", "of its torques"),
    "network_seed": (WHOLE, "", "the network; of held-out data its place in the order of trainings"),
    "test_seed": (WHOLE, "", "the walk; 0 of held-out data"),
    "stage": (TEXT, "", "of the standard deviations: `before` they are scaled, or `after`"),
    "metric": (TEXT, "", "`coverage` of a nominal share, `nll` [nats], the negative log-likelihood, or `crps` [unit]"),
    "share": (REAL, "-", "the nominal share; missing of the other two"),
    "value": (REAL, "", "the number of the run"),
}
WHY: Schema = {
    "data": (TEXT, "", "the training set"),
    "method": (TEXT, "", "what learned"),
    "way": (TEXT, "", "the way of learning; empty of a method that does not learn"),
    "measure": (TEXT, "", "what is measured, such as the share of a hit that is shown"),
    "inputs": (TEXT, "", "inputs that bring in a hit; empty of all other measures"),
    "robot": (TEXT, "", "the robot, or `all` of them"),
    "network": (REAL, "", "the network of a robot, counted from 0; missing of all robots"),
    "value": (REAL, "column `unit`", "the number"),
    "low": (REAL, "column `unit`", "the ends of its interval over robots; missing of a single network"),
    "high": (REAL, "column `unit`", ""),
    "unit": (TEXT, "", "its unit"),
}
DETECTION: Mapping[str, Schema] = {  # file of a robot's detectors -> its columns
    "collisions": COLLISIONS,
    "detected": DETECTED,
    "swings": SWINGS,
    "promises": PROMISES,
    "thresholds": THRESHOLDS,
    "curves": CURVES,
}


def frame_of(rows: Sequence[object], schema: Schema) -> pd.DataFrame:
    """Return rows of a dataclass as a frame with the columns of a schema."""
    columns: dict[str, pd.Series] = {}
    for name, (kind, _, _) in schema.items():
        columns[name] = pd.Series([getattr(row, name) for row in rows], dtype=kind)
    return pd.DataFrame(columns)


def typed(rows: Sequence[Mapping[str, Any]], schema: Schema) -> pd.DataFrame:
    """Return rows as a frame with the columns of a schema; what a row lacks is missing."""
    columns: dict[str, pd.Series] = {}
    for name, (kind, _, _) in schema.items():
        columns[name] = pd.Series([row.get(name) for row in rows], dtype=kind)
    return pd.DataFrame(columns)


def read_frame(path: Path, schema: Schema, may_lack: Collection[str] = ()) -> pd.DataFrame:
    """Read a CSV file as a frame with the columns of a schema; a number of those that `may_lack` one may be missing.

    Raises:
        DataError: the file is missing or damaged, a column is missing or a field is not a number where one is due; one
            line for each.
    """
    rows = read_texts(path, list(schema))
    faults: list[str] = []
    columns: dict[str, list[Any]] = {}
    for name, (kind, _, _) in schema.items():
        hint = HINTS[kind] | None if name in may_lack else HINTS[kind]
        # The names of the columns are line 1 of the file.
        columns[name] = [
            parse_field(row[name], hint, f"{path}:{line}: {name}", faults) for line, row in enumerate(rows, start=2)
        ]
    refuse_lines(faults)
    return pd.DataFrame({name: pd.Series(values, dtype=schema[name][0]) for name, values in columns.items()})


def read_scores(*paths: Path) -> pd.DataFrame:
    """Read errors of runs from files, one for each test and level: columns `SCORES`, one file after another.

    Raises:
        DataError: a file is missing or damaged, or a row is not accepted; one line for each fault.
    """
    return frame_of(score_rows(*paths), SCORES)


def read_detection(files: Mapping[str, Mapping[str, Path]], robots: Sequence[str], name: str) -> pd.DataFrame:
    """Read a file of the detectors of some robots: `robot`, and the columns that `DETECTION` has by the file's name.

    Raises:
        DataError: a file is missing or damaged, or a row is not accepted; one line for each fault.
    """
    parts = [frame_of(read_detections(files[robot][name], name), DETECTION[name]) for robot in robots]
    return pd.concat(parts, keys=list(robots), names=["robot"]).reset_index("robot").reset_index(drop=True)


def read_hits(files: Mapping[str, Mapping[str, Path]], robots: Sequence[str]) -> pd.DataFrame:
    """Read what the detectors of some robots said of each collision: columns `HITS`, a row for each rule of thresholds.

    Raises:
        DataError: a file is missing or damaged, or a detector saw a collision that is not among the robot's.
    """
    said = read_detection(files, robots, "detected").rename(columns=NAMED)
    hits = said.merge(read_detection(files, robots, "collisions"), how="left", on=["robot", *HIT], validate="m:1")
    lost = hits[hits["push"].isna()]
    if len(lost):
        robot, number, seed = lost[["robot", "number", "seed"]].iloc[0]
        raise DataError(
            f"{files[robot]['detected']}: {not_accepted('number', int(number), [f'collisions of walk {seed}'])}"
        )
    return hits.assign(found=hits["delay_s"].notna())[list(HITS)]


def read_trials(files: Mapping[str, Mapping[str, Path]], cases: Sequence[str]) -> pd.DataFrame:
    """Read the walks of all robots in some cases, case by case: columns `TRIALS`, and the level again as `robot`.

    Raises:
        DataError: a file is missing or damaged, or a row is not accepted; one line for each fault.
    """
    parts: list[pd.DataFrame] = []
    for case in cases:
        parts += [frame_of(trial_rows(of_robot[case]), TRIALS) for of_robot in files.values()]
    trials = pd.concat(parts, ignore_index=True)
    return trials.assign(robot=trials["level"])


def rows_of(rows: pd.DataFrame, **values: object) -> pd.DataFrame:
    """Return the rows whose columns hold what is given."""
    for name, value in values.items():
        rows = rows[rows[name] == value]
    return rows


def ordered(rows: pd.DataFrame, **orders: Sequence[str]) -> pd.DataFrame:
    """Return the rows whose columns have one of some values; groups by these columns stand in the order given.

    A later `pd.concat` keeps the order only where both parts have all values of a column in common.
    """
    for name, order in orders.items():
        rows = rows[rows[name].isin(order)]
        rows = rows.assign(**{name: pd.Categorical(rows[name], list(order))})
    return rows


def records_of(rows: pd.DataFrame, columns: Iterable[str]) -> list[list[Field]]:
    """Return columns of a frame as rows of a CSV file, whose fields are empty where a number is missing."""
    shown = rows[list(columns)].astype(object)
    return shown.where(shown.notna(), None).to_numpy().tolist()
