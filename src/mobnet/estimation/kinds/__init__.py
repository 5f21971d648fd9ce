"""Kinds of estimators, one a module: a method of the configuration names its kind."""
