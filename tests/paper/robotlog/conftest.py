"""Logs of a two-link arm."""

from arm_logs import arm_log, clean, stored

__all__ = ["arm_log", "clean", "stored"]
