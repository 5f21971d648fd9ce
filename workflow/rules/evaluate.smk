# Scores of all runs of a scenario; then the tables of errors, and a rule for each figure under its own number.

WINDOWS = settings["evaluation"]["windows"]  # around pushes: only there are recordings read
BUDGET = settings["evaluation"]["error_budget"]["tests"]  # of one scenario


rule score:
    input:
        lambda w: arrays(runs_of(w.scenario), "residual", "estimate"),
        lambda w: arrays(runs_of(w.scenario), "recording") if w.scenario in WINDOWS else [],
    output:
        ensure(f"{RESULTS}/scores/{{scenario}}.csv", non_empty=True),
    log:
        f"{RESULTS}/logs/score/{{scenario}}.log",
    benchmark:
        f"{RESULTS}/bench/score/{{scenario}}.tsv"
    threads: 1
    params:
        config=part("robot"),
        entries=lambda w: runs_of(w.scenario),
        window=lambda w: WINDOWS.get(w.scenario),
        robot=CONTENT["robot"],
        code=code_of("score"),
    script:
        "../scripts/score.py"


rule table:
    input:
        scores=lambda w: expand(f"{RESULTS}/scores/{{name}}.csv", name=scenarios_of_table(w.table)),
    output:
        ensure(
            expand(f"{TABLES}/{{{{table}}}}.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/{{table}}.log",
    benchmark:
        f"{RESULTS}/bench/{{table}}.tsv"
    wildcard_constraints:
        table="|".join(settings["evaluation"]["tables"]),
    threads: 1
    params:
        config=lambda w: config_of_table(w.table),
        robot=CONTENT["robot"],
        published=CONTENT["published"],
        code=code_of("table"),
    script:
        "../scripts/table.py"


rule error_budget:
    input:
        scores=f"{RESULTS}/scores/{BUDGET[0]['scenario']}.csv",
    output:
        ensure(
            expand(f"{TABLES}/error_budget.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/error_budget.log",
    benchmark:
        f"{RESULTS}/bench/error_budget.tsv"
    threads: 1
    params:
        config=part("seed", "robot", evaluation=["confidence", "bootstrap_draws", "error_budget"]),
        robot=CONTENT["robot"],
        code=code_of("error_budget"),
    script:
        "../scripts/error_budget.py"


rule figure_05:
    input:
        arrays(panels_of(FIGURE_05), "recording", "residual", "estimate"),
    output:
        ensure(figure_files("figure_05"), non_empty=True),
    log:
        f"{RESULTS}/logs/figure_05.log",
    benchmark:
        f"{RESULTS}/bench/figure_05.tsv"
    threads: 1
    params:
        config=part("robot", "published", evaluation=["figure_05"]) | sizes("figure_start_s"),
        entries=panels_of(FIGURE_05),
        robot=CONTENT["robot"],
        published=CONTENT["published"],
        code=code_of("figure_05"),
    script:
        "../scripts/figure_05.py"


rule claims:
    input:
        courses(folders_of_claims()),
        scores=expand(f"{RESULTS}/scores/{{name}}.csv", name=dict.fromkeys(name for name, _, _ in wanted())),
    output:
        ensure(
            expand(f"{TABLES}/claims.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/claims.log",
    benchmark:
        f"{RESULTS}/bench/claims.tsv"
    threads: 1
    params:
        config=part("seed", "robot", "claims", evaluation=["confidence", "bootstrap_draws"]),
        folders=folders_of_claims(),
        robot=CONTENT["robot"],
        claims=CONTENT["claims"],
        code=code_of("claims"),
    script:
        "../scripts/claims.py"
