# All trainings to look at: a page, and offline wandb runs, whose files tell the time and so differ each time.

WANDB = f"{RESULTS}/wandb"


rule runs:
    input:
        notes=networks("run.json"),
        metrics=networks("metrics.csv"),
        # code_of reads Python only
        templates=expand("src/mobnet/evaluation/report/templates/runs.{ending}", ending=["html", "css", "js"]),
    output:
        ensure(shown(f"{RESULTS}/runs.html", "trainings"), non_empty=True),
    log:
        f"{RESULTS}/logs/runs.log",
    benchmark:
        f"{RESULTS}/bench/runs.tsv"
    threads: 1
    params:
        config=part("scale"),
        code=code_of("runs"),
    script:
        "../scripts/runs.py"


rule wandb_runs:
    input:
        notes=networks("run.json"),
        metrics=networks("metrics.csv"),
    output:
        directory(WANDB),
    log:
        f"{RESULTS}/logs/wandb_runs.log",
    benchmark:
        f"{RESULTS}/bench/wandb_runs.tsv"
    threads: 1
    params:
        code=code_of("wandb_runs"),
    script:
        "../scripts/wandb_runs.py"
