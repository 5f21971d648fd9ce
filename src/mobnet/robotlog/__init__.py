"""The log of a robot of one's own: reading it, making a recording of it, and hints on what is wrong with it."""
