"""Rule `compute`: jobs, hours and memory of each stage."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.compute import compute

with job(snakemake.log[0]):
    compute(snakemake.params.config, Path(snakemake.params.benchmarks), Path(snakemake.output[0]).parent)
