"""The calibration and the trial of the detectors of a robot."""

from pathlib import Path

from experiments.jobs.detect import detect
from experiments.jobs.inputs import placed
from experiments.running.logs import job

with job(snakemake.log[0]):
    detect(
        **placed(snakemake.params.given, snakemake.input),
        out=Path(snakemake.output[0]).parent,
    )
