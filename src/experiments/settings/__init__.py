"""The sections of the configuration that only experiments read, and the whole of it, which `load` reads."""
