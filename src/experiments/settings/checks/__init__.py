"""What must hold between sections of the configuration of experiments."""
