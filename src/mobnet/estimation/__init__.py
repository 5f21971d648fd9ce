"""From what a robot senses to the torque its surroundings exert: observer, residual and direct estimators."""
