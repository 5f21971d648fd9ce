"""Bounds of the rate of samples and of the observer's gain, wherever they are given."""

# Of files that people pass on, too: what the C library accepts (src/runtime/cursor.h) lies further out.
RATE_HZ = (1.0, 100_000.0)
GAIN_HZ = (0.1, 5000.0)
