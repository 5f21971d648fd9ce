"""What detectors make of collisions."""
