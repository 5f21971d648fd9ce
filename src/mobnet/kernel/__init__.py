"""The observer for whatever Pinocchio reads: arrays and numbers alone, no configuration, no file, no command."""
