"""A robot that follows a known trajectory."""

from known_trajectory import follow, trajectory
from pushed_arm import pushed_arm

__all__ = ["follow", "pushed_arm", "trajectory"]
