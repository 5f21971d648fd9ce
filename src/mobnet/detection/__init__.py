"""Detection of collisions with a swinging leg (section 5.3): gate, filters, thresholds, detectors, links."""
