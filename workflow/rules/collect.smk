# Recordings of the walking robot, and what the observer makes of them. Memory [MB] and time [min] are those of the
# default scale, doubled. On a cluster, jobs of a group go into its queue together.


rule motion:
    input:
        lambda w: job("motion", w).inputs,
    output:
        both_files(PLAN.folders.results / "motions" / "{motion}" / "s{seed}"),
    log:
        f"{LOGS}/motion/{{motion}}-s{{seed}}.log",
    priority: 30
    group:
        "motions"
    threads: 1
    resources:
        mem_mb=growing(500),
        runtime=10,
    params:
        call=lambda w: job("motion", w).call,
        given=lambda w: job("motion", w).given,
    script:
        "../scripts/call.py"


rule collect:
    input:
        lambda w: job("collect", w).inputs,
    output:
        array("recordings", *RECORDING),
    log:
        f"{LOGS}/collect/{{robot}}{{scenario}}-{{level}}-s{{seed}}.log",
    priority: 20
    group:
        "walks"
    threads: 1
    resources:
        mem_mb=growing(1200),
        runtime=10,
    params:
        call=lambda w: job("collect", w).call,
        given=lambda w: job("collect", w).given,
    script:
        "../scripts/call.py"


use rule collect as collect_tests with:
    input:
        lambda w: job("collect_tests", w).inputs,
    output:
        tests(OF_PLANT, "recordings"),
    log:
        f"{LOGS}/collect_tests/{{robot}}{{scenario}}-{{level}}.log",
    wildcard_constraints:
        robot=PLANT,
    resources:
        mem_mb=growing(1200),
        runtime=30,
    params:
        call=lambda w: job("collect_tests", w).call,
        given=lambda w: job("collect_tests", w).given,


use rule collect_tests as collect_robots with:
    output:
        tests(OF_ROBOTS, "recordings"),
    wildcard_constraints:
        robot=ROBOTS,


ruleorder: collect_robots > collect_tests > collect


rule observe:
    input:
        lambda w: job("observe", w).inputs,
    output:
        array("residuals", *RECORDING),
    log:
        f"{LOGS}/observe/{{robot}}{{scenario}}-{{level}}-s{{seed}}.log",
    priority: 20
    group:
        "walks"
    threads: 1
    resources:
        mem_mb=growing(2300),
        runtime=10,
    params:
        call=lambda w: job("observe", w).call,
        given=lambda w: job("observe", w).given,
    script:
        "../scripts/call.py"


use rule observe as observe_tests with:
    input:
        lambda w: job("observe_tests", w).inputs,
    output:
        tests(OF_PLANT, "residuals"),
    log:
        f"{LOGS}/observe_tests/{{robot}}{{scenario}}-{{level}}.log",
    wildcard_constraints:
        robot=PLANT,
    params:
        call=lambda w: job("observe_tests", w).call,
        given=lambda w: job("observe_tests", w).given,


use rule observe_tests as observe_robots with:
    output:
        tests(OF_ROBOTS, "residuals"),
    wildcard_constraints:
        robot=ROBOTS,


ruleorder: observe_robots > observe_tests > observe
