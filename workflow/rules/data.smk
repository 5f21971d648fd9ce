# What the data are: Figure 19, how much of the tests they cover, and the tables of the training sets.


rule figure_19:
    input:
        training("recordings", "walk"),
        training("recordings", "walk_plain"),
        coverage_recordings(),
    output:
        ensure(figure_files("figure_19"), non_empty=True),
    log:
        f"{RESULTS}/logs/figure_19.log",
    benchmark:
        f"{RESULTS}/bench/figure_19.tsv"
    threads: 1
    params:
        config=part(evaluation=["figure_19", "coverage"]),
        training=exploration_sets(),
        tests=coverage_tests(),
        code=code_of("figure_19"),
    script:
        "../scripts/figure_19.py"


rule data_coverage:
    input:
        training("recordings", "walk"),
        training("recordings", "walk_plain"),
        coverage_recordings(),
    output:
        ensure(
            expand(f"{TABLES}/coverage.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/data_coverage.log",
    benchmark:
        f"{RESULTS}/bench/data_coverage.tsv"
    threads: 1
    params:
        config=part(
            "seed",
            "robot",
            "networks",
            evaluation=["coverage", "confidence", "bootstrap_draws"],
        ),
        training=exploration_sets(),
        tests=coverage_tests(),
        robot=CONTENT["robot"],
        code=code_of("data_coverage"),
    script:
        "../scripts/data_coverage.py"


rule data:
    input:
        [training("recordings", name) for name in SIZES["train"]],
    output:
        ensure(
            expand(f"{TABLES}/data.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/data.log",
    benchmark:
        f"{RESULTS}/bench/data.tsv"
    threads: 1
    params:
        config=part("robot", "published", "walking", "commands", "terrain", evaluation=["data"]),
        sets=training_stems("recordings", *SIZES["train"]),
        robot=CONTENT["robot"],
        published=CONTENT["published"],
        code=code_of("data"),
    script:
        "../scripts/data.py"


rule steps:
    input:
        training("recordings", "walk"),
    output:
        ensure(
            expand(f"{TABLES}/steps.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/steps.log",
    benchmark:
        f"{RESULTS}/bench/steps.tsv"
    threads: 1
    params:
        config=part("robot", "walking", "commands", evaluation=["steps"]),
        sets=training_stems("recordings", "walk"),
        robot=CONTENT["robot"],
        code=code_of("steps"),
    script:
        "../scripts/steps.py"


rule commands:
    input:
        [training("recordings", name) for name in SIZES["train"]],
    output:
        ensure(figure_files("commands"), non_empty=True),
    log:
        f"{RESULTS}/logs/commands.log",
    benchmark:
        f"{RESULTS}/bench/commands.tsv"
    threads: 1
    params:
        config=part("robot", "walking", "commands", evaluation=["commands"]),
        sets=training_stems("recordings", *SIZES["train"]),
        robot=CONTENT["robot"],
        code=code_of("commands"),
    script:
        "../scripts/commands.py"


rule uncertainty:
    input:
        [training("residuals", row["data"]) for row in settings["networks"].values()],
    output:
        ensure(
            expand(f"{TABLES}/uncertainty.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/uncertainty.log",
    benchmark:
        f"{RESULTS}/bench/uncertainty.tsv"
    threads: 1
    params:
        config=part("robot", "published", "networks", evaluation=["uncertainty"]),
        sets=training_stems("residuals", *(row["data"] for row in settings["networks"].values())),
        robot=CONTENT["robot"],
        published=CONTENT["published"],
        code=code_of("uncertainty"),
    script:
        "../scripts/uncertainty.py"
