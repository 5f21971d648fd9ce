# What methods without networks are fitted to, one network for each limb, method and seed; then every method on every test.


rule fit:
    input:
        lambda w: job("fit", w).inputs,
    output:
        ensure(f"{OWN}fits/{{method}}.json", non_empty=True),
    log:
        f"{LOGS}/fit/{{robot}}{{method}}.log",
    priority: 10
    group:
        "fits"
    threads: 1
    resources:
        mem_mb=growing(4000),
        runtime=10,
    params:
        call=lambda w: job("fit", w).call,
        given=lambda w: job("fit", w).given,
    script:
        "../scripts/call.py"


rule train:
    input:
        lambda w: job("train", w).inputs,
    output:
        ensure(
            expand(
                f"{PLAN.folders.results}/{{{{robot}}}}networks/{{{{method}}}}-{{{{limb}}}}-s{{{{seed}}}}/{{name}}",
                name=["weights.safetensors", "metrics.csv", "run.json"],
            ),
            non_empty=True,
        ),
    log:
        f"{LOGS}/train/{{robot}}{{method}}-{{limb}}-s{{seed}}.log",
    priority: 10
    threads: 1
    resources:
        mem_mb=growing(6000),
        runtime=30,
        gpu=GPU,
    params:
        call=lambda w: job("train", w).call,
        given=lambda w: job("train", w).given,
    script:
        "../scripts/call.py"


rule estimate:
    input:
        lambda w: job("estimate", w).inputs,
    output:
        tests(OF_PLANT, "estimates", "{method}", "n{network_seed}"),
    log:
        f"{LOGS}/estimate/{{robot}}{{method}}-n{{network_seed}}-{{scenario}}-{{level}}.log",
    wildcard_constraints:
        robot=PLANT,
    group:
        "estimates"
    threads: 1
    resources:
        mem_mb=growing(2800),
        runtime=10,
    params:
        call=lambda w: job("estimate", w).call,
        given=lambda w: job("estimate", w).given,
    script:
        "../scripts/call.py"


use rule estimate as estimate_robots with:
    output:
        tests(OF_ROBOTS, "estimates", "{method}", "n{network_seed}"),
    wildcard_constraints:
        robot=ROBOTS,
