"""The name by which Snakemake finds what a run shows, `--logger mobnet`; the code stands in `experiments.running`."""

from experiments.running.terminal import RunHandler as LogHandler

__all__ = ["LogHandler"]
