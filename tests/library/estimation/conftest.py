"""A robot that follows a known trajectory."""

from known_trajectory import changed_joints, follow, observer, trajectory
from pushed_arm import pushed_arm

__all__ = ["changed_joints", "follow", "observer", "pushed_arm", "trajectory"]
