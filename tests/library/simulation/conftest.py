"""Plants that walk or stand."""

from simulated_walks import motion, run, simulate, walk_of

__all__ = ["motion", "run", "simulate", "walk_of"]
