"""Trainings of few samples."""

from small_trainings import data, small

__all__ = ["data", "small"]
