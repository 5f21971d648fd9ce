"""Kinds of estimators: each is a module, which methods of the configuration name as their `kind`."""
