"""Trained limb networks as they run on a robot; nothing here imports the training, so no estimate depends on it."""
