"""Limb networks of MOB-Net (section 4): inputs, cells, loss, training, and `deployed`, which runs them on a robot."""
