"""Rule `observe`: the momentum observer's residual of a recording, and the low-passed truth."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.estimation.observe import observe

with job(snakemake.log[0]):
    observe(
        snakemake.params.config,
        Path(snakemake.input.array).with_suffix(""),
        Path(snakemake.output.array).with_suffix(""),
    )
