"""What is measured on training sets and tests: steps, motions, torques, coverage."""
