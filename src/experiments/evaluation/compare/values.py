"""One number of every joint of a run, as the modules of measures hand it to the scores."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Measured(NamedTuple):
    """A metric of n joints; nan where it is not defined, which makes no row.

    Its unit is that of `experiments.settings.metrics`. Where only the average counts, joints get no rows of their own.
    """

    metric: str
    values: NDArray[np.float64]
    average_only: bool = False


Measures = Iterator[Measured]
