"""What must hold between values, each module about one part of the configuration; it yields places and texts."""
