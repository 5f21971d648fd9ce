"""The configuration as frozen, typed sections with bounds, units and references; `load` reads it from `configs/`."""
