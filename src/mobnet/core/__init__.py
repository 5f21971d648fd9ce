"""What every other package shares: joint names, recordings, result files, configuration, errors."""
