"""Rule `uncertainty`: size of the uncertainty torque that the networks learn."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.evaluation.tables.uncertainty import uncertainty

with job(snakemake.log[0]):
    uncertainty(snakemake.params.config, snakemake.params.sets, Path(snakemake.output[0]).parent)
