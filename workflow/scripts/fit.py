"""Rule `fit`: what a method without networks learns from the training sets."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.estimation.fitting import write_fit

pairs = snakemake.params.training
with job(snakemake.log[0]):
    write_fit(
        snakemake.params.config,
        snakemake.wildcards.method,
        {limb: [(Path(recording), Path(residual)) for recording, residual in pairs[limb]] for limb in pairs},
        Path(snakemake.output[0]),
    )
