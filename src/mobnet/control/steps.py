"""Commands of steps: rows (5,) of step x, step y [m], turn [rad], duration [s] and foot height [m]."""

STEP_X, STEP_Y, TURN, DURATION, FOOT_HEIGHT = range(5)  # columns of a command
SIDES = (1.0, -1.0)  # of the left, right leg: +y is left
