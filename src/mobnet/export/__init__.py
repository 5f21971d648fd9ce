"""Trained networks as files that run without this project: ONNX with its contract, and how they run from Python."""
