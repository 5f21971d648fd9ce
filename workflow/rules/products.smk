# Scores of all runs of a test at a level; then every table, figure and text of the plan, each by a rule of its own name, and the
# trials, which `all` does not ask for.


rule score:
    input:
        lambda w: job("score", w).inputs,
    output:
        ensure(f"{PLAN.folders.results}/scores/{{scenario}}/{{level}}.csv", non_empty=True),
    log:
        f"{LOGS}/score/{{scenario}}-{{level}}.log",
    wildcard_constraints:
        level="|".join(dict.fromkeys(level for levels in SETTINGS.tests.values() for level in levels)),
    group:
        "scores"
    threads: 1
    resources:
        mem_mb=growing(500),
        runtime=5,
    params:
        call=lambda w: job("score", w).call,
        given=lambda w: job("score", w).given,
    script:
        "../scripts/call.py"


rule detect:
    input:
        lambda w: job("detect", w).inputs,
    output:
        [ensure(f"{OWN}detection/{name}.csv", non_empty=True) for name in DETECTION_FILES],
    log:
        f"{LOGS}/detect/{{robot}}all.log",
    group:
        "scores"
    threads: 1
    resources:
        mem_mb=growing(3000),
        runtime=20,
    params:
        call=lambda w: job("detect", w).call,
        given=lambda w: job("detect", w).given,
    script:
        "../scripts/call.py"


for product in (*PLAN.products, *PLAN.trials):

    rule:
        name:
            product.name
        input:
            product.job.inputs,
        output:
            [flagged(name) for name in product.outputs],
        log:
            f"{LOGS}/{product.name}.log",
        group:
            "tables"
        threads: 1
        resources:
            mem_mb=growing(1700),
            runtime=10,
        params:
            call=product.job.call,
            given=product.job.given,
        script:
            "../scripts/call.py"
