"""The name by which Snakemake finds what a run shows, `--logger mobnet`; the code stands in `experiments.running`.

Every Snakemake that finds this project's packages imports it before it reads a word.
"""

import sys

from experiments.running.environment import fault_of_snakemake

if fault := fault_of_snakemake():
    sys.exit(fault)

from experiments.running.terminal import RunHandler as LogHandler

__all__ = ["LogHandler"]
