"""Rows of the files that jobs write, and of those alone: scores, trials, falls, collisions, reactions, courses."""
