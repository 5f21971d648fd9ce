"""Whether files of results say what their places and the configuration say: whose they are, and how they were made.

A run asks of the notes and weights that it is about to read, before its first job; `./reproduce check` asks of each
file that it is given, and of its numbers too. What a file must be by itself is said elsewhere: `mobnet.core.contract`
and the readers.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path

from mobnet.agreement.arrays import array_faults
from mobnet.agreement.motions import motion_faults
from mobnet.agreement.networks import network_faults
from mobnet.agreement.numbers import number_faults
from mobnet.agreement.rows import fit_faults, score_faults
from mobnet.core.errors import refuse
from mobnet.plan.runs import NETWORKS, Files

Look = Callable[[Path, tuple[str, ...], Files], Iterator[str]]
LOOKS: Mapping[str, Look] = {  # folder below the results of a scale -> faults of a file in it
    "recordings": array_faults, "residuals": array_faults, "estimates": array_faults, "motions": motion_faults,
    NETWORKS: network_faults, "fits": fit_faults, "scores": score_faults,
}  # fmt: skip


def check_agreement(paths: Iterable[Path], files: Files, *, numbers: bool = False) -> None:
    """Check that files of results agree with their places; the others, and those that are not there, are left out.

    The numbers of arrays are looked at where that is asked for.

    Raises:
        DataError: a file is not the one that belongs to its place, or is not accepted; one line for each fault.
    """
    for path in paths:
        owner, place = files.owner_of(path)
        look = LOOKS.get(place[0])
        if look and path.exists():
            refuse(path, look(path, place, owner))
            if numbers:
                refuse(path, number_faults(path, place, owner))
