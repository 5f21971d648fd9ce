"""Walking controller: footsteps, balance, swing and whole-body torques, compiled and called at the plant's rate."""
