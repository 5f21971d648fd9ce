"""Rule `train`: one limb network; a killed training goes on from its last epoch."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.learning.train import train

with job(snakemake.log[0]):
    train(
        snakemake.params.config,
        snakemake.wildcards.method,
        snakemake.wildcards.limb,
        int(snakemake.wildcards.seed),
        [Path(name).with_suffix("") for name in snakemake.input.recordings],
        [Path(name).with_suffix("") for name in snakemake.input.residuals],
        Path(snakemake.output.weights).parent,
        Path(snakemake.params.state),
    )
