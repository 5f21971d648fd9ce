"""Rule `figure_19`: Figure 19 of the paper, velocity and torque in training and tests."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.figures.figure_19 import figure_19

with job(snakemake.log[0]):
    figure_19(
        snakemake.params.config, snakemake.params.training, snakemake.params.tests, Path(snakemake.output[0]).parent
    )
