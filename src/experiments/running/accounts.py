"""What jobs took: the account that each of them leaves beside its log, of which tables of compute are made."""

from dataclasses import dataclass
from pathlib import Path

from pydantic import ConfigDict

from mobnet.core.code import UNKNOWN
from mobnet.core.errors import not_accepted, refuse
from mobnet.core.notes import Note, NotNegative, Text, read_note


@dataclass(frozen=True)
class Account:
    """What a job took in time [s] and memory [MiB], from the start of its work to its end, without Python's own start.

    `job` is the name of its log below the folder of logs, of which the first part is that of its rule. Start and end
    are in seconds since 1970, UTC; `wall_s` is by a clock that nobody sets. Processor time and peak memory include the
    children that it waited for. `succeeded` is False where it failed or was interrupted; `commit` is that of the code,
    as results note it.
    """

    job: str
    start_s: float
    end_s: float
    wall_s: float
    cpu_s: float
    peak_mib: float
    succeeded: bool
    commit: str = UNKNOWN


class AccountNote(Note):
    """The file of an `Account`."""

    model_config = ConfigDict(extra="forbid")

    job: Text
    start_s: NotNegative
    end_s: NotNegative
    wall_s: NotNegative
    cpu_s: NotNegative
    peak_mib: NotNegative
    succeeded: bool
    commit: Text = UNKNOWN


def read_account(path: Path) -> Account:
    """Read what one job took.

    Raises:
        DataError: the file is missing or damaged, or a key or a value is not accepted; one line for each.
    """
    note = read_note(path, AccountNote)
    if note.end_s < note.start_s:
        refuse(path, [not_accepted("end_s", note.end_s, [f"{note.start_s} or more, the start"])])
    return Account(**dict(note))
