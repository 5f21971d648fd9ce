"""A recording as a table of pandas and as a picture, for notebooks."""

from collections.abc import Sequence

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from mobnet.core.columns import recording_columns
from mobnet.core.joints import JointLayout
from mobnet.core.recording import SensedRecording


def frame_of(recording: SensedRecording, layout: JointLayout) -> pd.DataFrame:
    """Return a row for each sample, a column for each sensed signal, named as in files, and the time [s] as index."""
    columns = recording_columns(layout)
    parts: list[pd.DataFrame] = []
    for field, values in vars(recording.sensed).items():
        names = [name for name, *_ in columns[field]]
        parts.append(pd.DataFrame(np.asarray(values), columns=names))
    time = pd.Index(np.arange(len(recording.sensed)) / recording.rate_hz, name="time")
    return pd.concat(parts, axis=1).set_index(time)


def plot_of(recording: SensedRecording, motors: Sequence[str], most_named: int) -> Figure:
    """Return a figure of positions [rad], velocities [rad/s] and torques [N m] over time [s]; a legend names few."""
    sensed = recording.sensed
    count = len(motors)
    time = np.arange(len(sensed)) / recording.rate_hz
    shown = {
        "position [rad]": sensed.q[:, -count:],
        "velocity [rad/s]": sensed.v[:, -count:],
        "torque of the motor [N m]": sensed.tau_motor,
    }
    figure, panels = plt.subplots(len(shown), 1, sharex=True, figsize=(8, 7), layout="constrained")
    for panel, (title, values) in zip(panels, shown.items(), strict=True):
        panel.plot(time, values, linewidth=0.8)
        panel.set_ylabel(title)
    panels[-1].set_xlabel("time [s]")
    if count <= most_named:
        panels[0].legend(motors, ncols=count, fontsize="small")
    return figure
