"""Figure 19: which joint velocities and torques training and test data hold."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.files import write_text
from mobnet.core.store import read_array
from mobnet.evaluation.data_figures import Cloud, draw_clouds
from mobnet.evaluation.figures import save_figure
from mobnet.evaluation.rows import csv_text
from mobnet.evaluation.samples import Pushed, evenly, pushed_of

log = logging.getLogger(__name__)


def figure_19(
    config: Mapping[str, Any],
    training: Mapping[str, Sequence[str]],
    tests: Sequence[Mapping[str, Any]],
    out_dir: Path,
) -> None:
    """Write Figure 19, desired torque [N m] over velocity [rad/s] of some joints, as PDF, PNG and CSV.

    Args:
        config: resolved configuration: `evaluation.figure_19` (joints, dots of each training set, test_dots of
            all tests together) and, for pushes, `evaluation.coverage`.
        training: name of a training set -> stems of its recordings; a row of panels each.
        tests: scenario and `recordings`, the stems, of each test; `pushed`, a joint, where only samples around pushes
            count. Shown together, each with the same number of dots.
        out_dir: gets figure_19.pdf, .png and .csv.

    Raises:
        DataError: a file or a column is missing.
    """
    settings = config["evaluation"]["figure_19"]
    joints, share = settings["joints"], settings["test_dots"] // len(tests)
    learnt = {name: read_dots(list(map(Path, stems)), joints, settings["dots"]) for name, stems in training.items()}
    tested = {
        test["scenario"]: read_dots(
            list(map(Path, test["recordings"])), joints, share, pushed_of(test, config["evaluation"]["coverage"])
        )
        for test in tests
    }
    together = np.concatenate(list(tested.values()))
    clouds = [
        Cloud(joint, name, dots[:, k], together[:, k])
        for name, dots in learnt.items()
        for k, joint in enumerate(joints)
    ]
    rows = [
        (kind, name, joint, *dot)
        for kind, sets in (("training", learnt), ("test", tested))
        for name, dots in sets.items()
        for k, joint in enumerate(joints)
        for dot in dots[:, k].tolist()
    ]
    write_text(out_dir / "figure_19.csv", csv_text(("kind", "set", "joint", "velocity_rad_s", "torque_nm"), rows))
    save_figure(draw_clouds(clouds, "test"), out_dir / "figure_19")
    log.info("%s: %d dots", out_dir / "figure_19.pdf", len(rows))


def read_dots(
    stems: Sequence[Path], joints: Sequence[str], count: int, pushed: Pushed | None = None
) -> NDArray[np.float32]:
    """Return velocity [rad/s] and desired torque [N m] of joints at evenly spread samples (n, joints, 2).

    Args:
        stems: recordings, paths without a suffix.
        joints: actuated joints.
        count: dots wanted of all recordings together; fewer where they hold fewer.
        pushed: look at these samples only.
    """
    names = [f"{quantity}.{joint}" for joint in joints for quantity in ("v", "tau_des")]
    arrays = []
    for stem in stems:
        array, meta = read_array(stem, names)
        spans = pushed.spans(stem) if pushed else meta["segments"]
        arrays += [array[start:end] for start, end in spans]
    together = np.concatenate([*arrays, np.zeros((0, len(names)), dtype=np.float32)])
    return together[evenly(len(together), count)].reshape(-1, len(joints), 2)
