"""Compile what many jobs run, once, before a cluster's jobs begin: with any scenario and level, for the code is one."""

import logging

from experiments.plan.jobs import walk_settings
from experiments.settings.load import load_settings
from experiments.warm import warm

logging.basicConfig(format="%(message)s")
logging.getLogger("experiments.warm").setLevel(logging.INFO)
settings = load_settings()
warm(walk_settings(settings, next(iter(settings.scenarios)), next(iter(settings.levels))), settings.detection)
