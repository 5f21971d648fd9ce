"""The configuration as frozen, typed sections with bounds, units and references; `lab` reads what a lab needs of it."""
