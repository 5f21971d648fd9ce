"""Hints on what is wrong with a log: each is a line with numbers; none of them stops anything."""
