"""What is measured on estimates of the external torque: the scores."""
