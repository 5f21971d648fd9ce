"""Rule `estimate`: a method's external torque for a recording."""

from pathlib import Path

from mobnet.core.logs import job
from mobnet.estimation.estimate import estimate

networks = dict(zip(snakemake.params.limbs, snakemake.input.networks, strict=True))
with job(snakemake.log[0]):
    estimate(
        snakemake.params.config,
        snakemake.wildcards.method,
        Path(snakemake.input.array).with_suffix(""),
        {limb: Path(weights).parent for limb, weights in networks.items()},
        Path(snakemake.output.array).with_suffix(""),
        next(map(Path, snakemake.input.fit), None),
    )
