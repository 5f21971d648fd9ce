"""Many networks of one shape that learn side by side: their weights are one tensor, and one product serves all.

A GPU has so many units that a single network leaves most of them idle (docs/notes/training.md).
"""
