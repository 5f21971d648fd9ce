"""Plants that walk or stand."""

from simulated_walks import motion, walk_of

__all__ = ["motion", "walk_of"]
