"""The public logs of a UR10e, where somebody has them: MOBNET_UR10E names a copy of the repository that holds them.

It is github.com/shamilmamedov/dynamic_calibration, which has no licence: nothing of it is in this project. Its files
have rows of time, positions, velocities, currents, target currents and target torques of the joints at about 94 Hz,
without a header. Torques are currents times the drive gains that the repository's paper estimates.
"""

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.robot.import_table import main as import_table

UR10E = os.environ.get("MOBNET_UR10E")
GAINS = [14.87, 13.26, 11.13, 10.62, 11.03, 11.47]  # N m/A


def ur10e_rows(name: str) -> NDArray[np.float64]:
    """Return the rows of a log (T, 31)."""
    (path,) = Path(str(UR10E)).glob(f"dataset_ur10e/*/ur-{name}.csv")
    rows = [line.split(",") for line in path.read_text().splitlines() if line.strip()]
    return np.array(rows, dtype=float)


def write_ur10e_table(path: Path) -> None:
    """Write the robot's table of its description."""
    description = str(Path(str(UR10E)) / "URe/urdf/ur10e.urdf")
    assert import_table([description, "--base", "fixed", "--out", str(path)]) == 0
