"""Rule `collect`: walk a scenario and record it."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.simulation.record import collect

with job(snakemake.log[0]):
    collect(
        snakemake.params.config,
        snakemake.wildcards.scenario,
        snakemake.wildcards.level,
        int(snakemake.wildcards.seed),
        snakemake.params.duration_s,
        Path(snakemake.output.array).with_suffix(""),
        Path(snakemake.input.motion[0]).with_suffix("") if snakemake.input.motion else None,
    )
