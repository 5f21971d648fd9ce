"""Reading what a job of the workflow took: the account that it wrote beside its log."""

from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.core.files import read_json
from mobnet.core.logs import Account


def read_account(path: Path) -> Account:
    """Read what one job took.

    Raises:
        DataError: the file is damaged, or is not an account.
    """
    found, wanted = read_json(path), Account.__annotations__
    wrong = [key for key in {**wanted, **found} if not isinstance(found.get(key), wanted.get(key, ()))]
    if wrong:
        raise DataError(f"{path}: {wrong[0]}: {found.get(wrong[0])!r} is not accepted; accepted: the account of a job")
    return Account(**found)
