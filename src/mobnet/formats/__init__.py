"""What files say of a robot, a network, thresholds and a log: typed sections with bounds, units and references."""
