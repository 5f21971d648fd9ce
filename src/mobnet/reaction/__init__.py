"""Handling collisions in a closed loop, section 7: detection, isolation, identification, classification, reaction."""
