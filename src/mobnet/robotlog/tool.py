"""The external torque that a sensor at an end effector tells: tau_e = J^T F of (2), the truth of a log's recording."""

from dataclasses import replace

import numpy as np

from mobnet.core.columns import EXTERNAL
from mobnet.core.recording import ABSENT
from mobnet.robot.frames import rotation
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import point_torque
from mobnet.robotlog.convert import Converted
from mobnet.settings.robotlog import Tool


def with_tool(found: Converted, nominal: NominalModel, tool: Tool) -> Converted:
    """Return a log whose recording has the external torque by the sensor of a tool (T, nv) [N] and [N m].

    Raises:
        ConfigError: the robot has no such body.
    """
    if found.tool is None:
        return found
    read = found.recording
    axes = rotation(np.array(tool.quat))
    torque = point_torque(nominal, tool.body, tool.pos, axes, read.sensed.q, found.tool)
    absent = tuple(name for name in found.absent if name != EXTERNAL)
    known = replace(read, truth=replace(read.truth, tau_ext=torque), meta={**read.meta, ABSENT: list(absent)})
    return replace(found, recording=known, absent=absent)
