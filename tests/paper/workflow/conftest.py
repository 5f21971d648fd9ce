"""What Snakemake plans; nothing is run."""

from planned_jobs import outputs, planned, snakemake

__all__ = ["outputs", "planned", "snakemake"]
