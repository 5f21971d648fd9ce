"""Estimating the external torque from what a robot senses: the observer, kinds of estimators and their fits."""
