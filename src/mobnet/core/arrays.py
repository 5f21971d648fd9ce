"""The type of the arrays of numbers: double precision in physics and control."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
