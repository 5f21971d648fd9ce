"""What a log of free motion tells of a robot: friction, rotor inertia, a payload (docs/identify.md)."""
