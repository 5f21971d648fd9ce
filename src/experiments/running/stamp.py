"""The stamp of a file of results, by which a file that another configuration or other code has made is noticed.

A stamp is a hash of the arguments that the plan gives for this file alone, of the code behind it, of its place and of
its content. It stands in the note of an array, a fit or a network, to whose content weights and epochs belong; those of
files of rows stand in the account of their job. What else a job makes does not count: jobs may be divided otherwise.
"""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from experiments.running.logs import read_account
from mobnet.core.code import SHORT
from mobnet.core.errors import DataError
from mobnet.core.files import METRICS, RUN, WEIGHTS, read_json, write_json

NOTE = ".json"
KEY = "stamp"


@dataclass(frozen=True)
class Stamps:
    """What a job stamps: note, or file of rows -> hash of what it is made from, with paths below the project's folder.

    Snakemake, which stores dictionaries with each output of a job, does not store an object of this class.
    """

    given: Mapping[str, str]

    def write(self, root: Path = Path()) -> dict[str, str]:
        """Write the stamps into the notes, and return those of the files of rows."""
        for name in filter(is_note, self.given):
            write_json(root / name, {**_unstamped(root / name), KEY: self._stamp(root, name)})
        return {name: self._stamp(root, name) for name in self.given if not is_note(name)}

    def fit(self, root: Path, account: str, name: str) -> bool:
        """Return whether a file that this job makes has its stamp, which may stand in the job's account."""
        place = stamped(name)
        try:
            kept = read_json(root / place).get(KEY) if is_note(place) else read_account(root / account).stamps.get(name)
            return kept == self._stamp(root, place)
        except (DataError, OSError):
            return False

    def _stamp(self, root: Path, name: str) -> str:
        """Return the stamp of a note or a file of rows as it stands, and of the files of a network beside its note."""
        path = root / name
        own = json.dumps(_unstamped(path), sort_keys=True).encode() if is_note(name) else path.read_bytes()
        beside = [path.with_name(other).read_bytes() for other in (WEIGHTS, METRICS) if path.name == RUN]
        digests = [hashlib.sha256(content).hexdigest() for content in (own, *beside)]
        return hashlib.sha256(" ".join([self.given[name], name, *digests]).encode()).hexdigest()[:SHORT]


def is_note(name: str) -> bool:
    """Return whether a file is a note, which has a stamp in itself."""
    return name.endswith(NOTE)


def stamped(name: str) -> str:
    """Return the note with the stamp of a file; a file of rows has none."""
    path = Path(name)
    if path.suffix == ".parquet":
        return f"{name.removesuffix(path.suffix)}{NOTE}"
    return str(path.with_name(RUN)) if path.name in (WEIGHTS, METRICS) else name


def _unstamped(path: Path) -> dict[str, object]:
    """Return the content of a note without its stamp."""
    return {key: value for key, value in read_json(path).items() if key != KEY}
