"""Limb networks of MOB-Net (section 4): inputs, streams, loss, training, and running them on a robot."""
