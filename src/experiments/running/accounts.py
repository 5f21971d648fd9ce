"""Reading what a job of the workflow took: the account that it wrote beside its log."""

from pathlib import Path

from pydantic import ConfigDict

from experiments.running.logs import Account
from mobnet.core.errors import not_accepted, refuse
from mobnet.core.notes import Note, NotNegative, Text, read_note
from mobnet.core.provenance import UNKNOWN


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
