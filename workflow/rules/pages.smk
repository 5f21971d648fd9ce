# What a reader looks at: pages of the tables for Snakemake's report, and how long everything took.

COMPUTE = expand(f"{RESULTS}/compute.{{ending}}", ending=["csv", "tex", "md"])  # differs from run to run


rule compute:
    input:
        MANIFEST,  # all jobs but a few views have been done
        WANDB,
    output:
        ensure(COMPUTE, non_empty=True),
    log:
        f"{RESULTS}/logs/compute.log",
    threads: 1
    params:
        config=part(evaluation=["compute"]),
        benchmarks=f"{RESULTS}/bench",
        logs=f"{RESULTS}/logs",
        code=code_of("compute"),
    script:
        "../scripts/compute.py"


rule pages:
    input:
        tables=[*expand(f"{TABLES}/{{name}}.md", name=TABLE_NAMES), f"{RESULTS}/compute.md"],
        captions=expand("workflow/report/tables/{name}.rst", name=[*TABLE_NAMES, "compute"]),
        template="src/mobnet/evaluation/report/templates/table.html",  # code_of reads Python only
    output:
        ensure(
            [shown(f"{RESULTS}/pages/{name}.html", "tables") for name in [*TABLE_NAMES, "compute"]],
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/pages.log",
    threads: 1
    params:
        code=code_of("pages"),
    script:
        "../scripts/pages.py"
