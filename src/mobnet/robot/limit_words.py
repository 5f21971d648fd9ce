"""The words of a command that give limits of joints, against the bounds of a table."""

from argparse import Namespace

from mobnet.core.errors import beyond, refuse_lines
from mobnet.formats.parts import ARMATURE, SPEED_RAD_S, TORQUE_NM


def check_limits(options: Namespace) -> None:
    """Raise a DataError where what `robot` is to take for joints lies outside the bounds of a table."""
    bounds = {"torque_limit": TORQUE_NM, "speed_limit": SPEED_RAD_S, "armature": ARMATURE}
    for name, accepted in bounds.items():
        refuse_lines(beyond(f"--{name.replace('_', '-')}", vars(options)[name], accepted))
