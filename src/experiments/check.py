"""Check files from outside before anything reads them: `./reproduce check FILE...` (docs/log_formats.md).

Readers of jobs ask for the same contract; here all columns of a file are looked at, in the memory of a minute of it.
"""

import logging
import math
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from experiments.evaluation.measure.estimates.scores import measure_problems
from experiments.evaluation.measure.learning.trainings import TrainingNote, read_training, read_training_note
from experiments.evaluation.number.rows import read_detections, read_scores, read_trials
from experiments.jobs.method_problems import method_problems
from experiments.records.collisions import FILES as DETECTION_FILES
from experiments.records.collisions import columns_of
from experiments.records.reactions import TRIALS
from experiments.records.scores import SCORES
from experiments.running.accounts import AccountNote, read_account
from experiments.running.words import KINDS, check_parser
from experiments.settings.load import load_settings
from mobnet.core.columns import EXTERNAL, LABEL_LP, RESIDUAL, STD, named, recording_columns, residual_columns
from mobnet.core.epochs import EPOCHS, read_epochs
from mobnet.core.errors import DataError, MobnetError, not_accepted, refuse
from mobnet.core.files import METRICS, RUN, check_regular, read_json, read_text
from mobnet.core.heartbeat import heartbeat
from mobnet.core.joints import JointLayout
from mobnet.core.notes import ArrayNote, read_array_note, read_note
from mobnet.core.printed import to_output
from mobnet.core.recording import Sensed, Truth
from mobnet.core.store import ARRAY, NOTE, check_rate, file_of, read_pieces
from mobnet.detection.threshold_file import read_thresholds
from mobnet.estimation.kinds.dahl import DahlNote, read_dahl
from mobnet.estimation.kinds.friction import FrictionNote, read_friction
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.loading import load_section
from mobnet.formats.reading import read_yaml
from mobnet.formats.robot import RobotTable
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.loading import check_limb, deployed
from mobnet.learning.deployed.weights import read_weights
from mobnet.robot.given import given_table
from mobnet.robotlog.formats import FORMATS, format_of
from mobnet.robotlog.wrenches import WRENCH_SIGNALS, wrench_columns
from mobnet.settings.lab import Lab, load_lab

FITS = {FrictionNote: read_friction, DahlNote: read_dahl}
NOTES = (ArrayNote, TrainingNote, AccountNote, *FITS)
HALF = 0.5  # of the columns of a kind, which a file of rows has to pass to be one
REPORT_S = 5.0  # between two lines of progress
log = logging.getLogger(__name__)
LOGGED = ("q.", "v.", "tau_motor.")  # first characters of columns of a log


class UnknownKindError(DataError):
    """A file is none of those that can be checked."""

    def __init__(self, path: Path, what: str, value: object) -> None:
        """Say what of a file was looked at, and which kinds are accepted."""
        super().__init__(f"{path}: {not_accepted(what, value, [KINDS])}")


class LogError(UnknownKindError):
    """A file is the log of a robot."""

    def __init__(self, path: Path) -> None:
        """Say what looks at it."""
        DataError.__init__(self, f"{path}: a log; accepted: {KINDS}; what is wrong with it says `./reproduce observe`")


@dataclass(frozen=True)
class Against:
    """What files are compared with: a robot's table and a rate [Hz], those of the configuration where none is given."""

    robot: Path | None = None
    rate: float | None = None

    @cached_property
    def lab(self) -> Lab:
        """What the configuration says of the robot and its recordings."""
        return load_lab()

    @cached_property
    def layout(self) -> JointLayout:
        """The robot's joints."""
        return given_table(self.robot, self.lab.robot).layout

    @cached_property
    def rate_hz(self) -> float:
        """Samples per second of recordings [Hz]."""
        return self.rate or self.lab.rates.data_hz


def check(path: Path, against: Against) -> str:
    """Return what a file is, in a few words.

    Raises:
        MobnetError: the file is not accepted; one line for each fault.
    """
    if path.is_dir():
        raise UnknownKindError(path, "folder without any of these", path.name)
    check_regular(path)
    is_array = path.suffix == NOTE and path.with_suffix(ARRAY).exists()
    reader = READERS.get(ARRAY if is_array else path.suffix)
    if reader is None and path.exists() and format_of(path) in FORMATS:
        raise LogError(path)
    if reader is None:
        raise UnknownKindError(path, "file" if path.exists() else "missing file", path.name)
    return reader(path, against)


def _array(path: Path, against: Against) -> str:
    """Check a recording, residual, estimate, wrench or motion, of whose files one is given."""
    stem = path.with_suffix("")
    note = read_array_note(file_of(stem, NOTE))
    noted = file_of(stem, NOTE)
    names = [column["name"] for column in note["columns"]]
    kind, needed = kind_of(noted, names, against.layout)
    refuse(noted, (f"columns: {name!r} is missing; accepted: all of a {kind}" for name in needed if name not in names))
    if kind != "motion":
        check_rate(stem, against.rate_hz)
    reported_s = time.monotonic()
    for first, columns in read_pieces(stem, note, names, against.layout):
        if time.monotonic() - reported_s > REPORT_S:
            reported_s = time.monotonic()
            log.info("%s: %d of %d rows", stem, first + columns.shape[1], note["rows"])
    rows = note["rows"]
    rate = note["rate_hz"]
    count = len(note["segments"])
    parts = f"{count} segment" + "s" * (count > 1)
    return f"{kind}, {rows} rows at {rate:g} Hz, {rows / rate:g} s in {parts}, {len(names)} columns"


def kind_of(noted: Path, names: Sequence[str], layout: JointLayout) -> tuple[str, list[str]]:
    """Return which kind of array has columns of these names, as its note says, and the columns that it needs."""
    given = set(names)
    groups = recording_columns(layout)
    signals = {name.partition(".")[0] for name in given}
    if {"q", "v"} & signals:
        needed: list[str] = []
        for field in Sensed.__dataclass_fields__:
            needed += [name for name, *_ in groups[field]]
        for field in Truth.__dataclass_fields__:
            columns = [name for name, *_ in groups[field]]
            # A recording may have some quantities of the truth, or none, but each of them whole.
            needed += columns if given.intersection(columns) else []
        return "recording", needed
    if RESIDUAL in signals:
        return "residual", [name for name, *_ in residual_columns(layout, LABEL_LP in signals)]
    if EXTERNAL in signals:
        joints = [joint for joint in layout.names if given & set(named(EXTERNAL, [joint]) + named(STD, [joint]))]
        needed = named(EXTERNAL, joints)
        # Methods without networks give no standard deviation.
        needed += named(STD, joints) if STD in signals else []
        return "estimate", needed
    if signals <= WRENCH_SIGNALS:
        return "wrench", wrench_columns({name.partition(".")[2] for name in given})
    if signals == {"q_ref"}:
        return "motion", [name for name in named("q_ref", layout.actuated) if name in given]
    raise UnknownKindError(noted, "columns", list(names))


def _note(path: Path, against: Against) -> str:
    """Check a JSON file that is no array's."""
    keys = read_json(path).keys()
    kind = max(NOTES, key=lambda note: len(keys & note.model_fields.keys()))
    if path.name != RUN and not keys & kind.model_fields.keys():
        raise UnknownKindError(path, "keys", sorted(keys))
    if kind is TrainingNote or path.name == RUN:
        return _training(path.parent)
    if kind is AccountNote:
        return f"account of {read_account(path).job}"
    if kind in FITS:
        FITS[kind](path, against.layout.actuated)
        return f"fit of {len(read_note(path, kind).joints)} joints"
    return _array(path, against)


def _training(folder: Path) -> str:
    """Check the note of a training, and its epochs where they are there."""
    note = read_training_note(folder)
    if (folder / METRICS).exists():
        read_training(folder)
    return f"training {note.name}, {note.settings.epochs} epochs"


def _rows(path: Path, against: Against) -> str:
    """Check a file of rows: epochs of a training, scores, walks into obstacles, or what detectors find."""
    del against  # files of rows name joints of any robot
    columns_given = set(read_text(path).partition("\n")[0].strip().split(","))
    kinds = {"epochs": EPOCHS, "scores": SCORES, "trials": TRIALS}
    kinds |= {name: columns_of(name) for name in DETECTION_FILES}
    shares = {name: len(columns_given.intersection(columns)) / len(columns) for name, columns in kinds.items()}
    kind = max(shares, key=lambda name: shares[name])
    if path.name == METRICS or (kind == "epochs" and shares[kind]):
        return _training(path.parent) if (path.parent / RUN).exists() else f"{len(read_epochs(path)[0])} epochs"
    if any(name.startswith(LOGGED) for name in columns_given):
        raise LogError(path)
    if shares[kind] <= HALF:
        raise UnknownKindError(path, "columns", sorted(columns_given))
    if kind == "scores":
        return f"scores, {len(read_scores(path))} rows"
    if kind == "trials":
        return f"walks into obstacles, {len(read_trials(path))} rows"
    return f"{kind} of detectors, {len(read_detections(path, kind))} rows"


def _network(path: Path, against: Against) -> str:
    """Check the weights of a network."""
    network = deployed(*read_weights(path))
    check_limb(network, network.limb, path, against.layout)
    LimbNetworks([network], against.layout)
    return f"network of {network.limb}, {len(network.input_names)} inputs, {len(network.joints)} joints"


def _configuration(path: Path, against: Against) -> str:
    """Check a file of the configuration, with the others of its folder, or a robot's table."""
    del against  # the file says what is accepted itself
    keys = read_yaml(path, nulls=True).keys()
    if len(keys & LimbThresholds.model_fields.keys()) > HALF * len(LimbThresholds.model_fields):
        return f"thresholds of {read_thresholds(path).limb}"
    if len(keys & RobotTable.model_fields.keys()) > 2:
        return f"robot {load_section(path, RobotTable).name}"
    folder = next((folder for folder in path.absolute().parents[:2] if (folder / "config.yaml").is_file()), None)
    if folder is None:
        raise UnknownKindError(path, "keys", sorted(keys))
    settings = load_settings(folder, further=lambda read: [*method_problems(read), *measure_problems(read)])
    return f"configuration of scale {settings.scale}, with the other files of {folder}"


READERS = {ARRAY: _array, NOTE: _note, ".csv": _rows, ".safetensors": _network, ".yaml": _configuration}


def files_of(path: Path) -> list[Path]:
    """Return the files that a word stands for: of a folder, all that may be of a known kind; of an array, its note."""
    if path.is_dir():
        inside = (file for file in sorted(path.rglob("*")) if file.suffix in READERS and not file.is_dir())
        files = [file for file in inside if not (file.suffix == ARRAY and file.with_suffix(NOTE).exists())]
        return files or [path]
    ends = [file_of(path, ending) for ending in (NOTE, ARRAY) if file_of(path, ending).exists()]
    return [path] if path.exists() or not ends else ends[:1]


def accepted(file: Path, against: Against, asked: bool) -> bool:
    """Check a file, print a line for it or one for each fault, and return whether it is accepted.

    In a folder, a file of another kind that nobody asked for is left out.
    """
    try:
        log.info("%s: ok: %s", file, check(file, against))
        return True
    except UnknownKindError as error:
        log.info("%s", error if asked else f"{file}: left out: another kind of file")
        return not asked
    except MobnetError as error:
        log.info("%s", error)
    except OSError as error:
        log.info("%s: cannot be read: %s; accepted: a file that you may read", file, error.strerror)
    return False


def main(words: list[str]) -> int:
    """Check some files and return the exit status: 0 if all are accepted."""
    parser = check_parser()
    options = parser.parse_args(words)
    if options.rate is not None and not 0.0 < options.rate < math.inf:
        parser.error(not_accepted("--rate", options.rate, ["a number above 0"]))
    output = to_output()
    against = Against(options.robot, options.rate)
    files: dict[Path, bool] = {}
    try:
        for word in options.files:
            files |= {file: file in options.files for file in files_of(word)}
    except OSError as error:
        parser.error(f"FILE: {error.filename}: {error.strerror}; accepted: files that you may read")
    with heartbeat():
        wrong = sum(not accepted(file, against, asked) for file, asked in files.items())
    if len(files) != 1:
        log.info("%d files, %d of them not accepted", len(files), wrong)
    return 1 if wrong or output.is_cut else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
