# Figures of sections 5.1 and 5.2 that show estimates over time: one recording, and errors of all.

FIGURES_5 = {
    name: settings["evaluation"][name] for name in ("figure_06", "figure_07", "figure_08", "figure_09", "figure_10")
}
COLLISIONS = FIGURES_5["figure_10"]["tests"]


rule figure_06:
    input:
        curves_of(FIGURES_5["figure_06"]),
        scores=f"{RESULTS}/scores/{FIGURES_5['figure_06']['scenario']}.csv",
    output:
        ensure([*figure_files("figure_06"), f"{FIGURES}/figure_06_bars.csv"], non_empty=True),
    log:
        f"{RESULTS}/logs/figure_06.log",
    benchmark:
        f"{RESULTS}/bench/figure_06.tsv"
    threads: 1
    params:
        config=part(
            "seed",
            "robot",
            "published",
            evaluation=["figure_06", "confidence", "bootstrap_draws"],
        ),
        entries=first_runs(FIGURES_5["figure_06"]),
        robot=CONTENT["robot"],
        published=CONTENT["published"],
        code=code_of("figure_06"),
    script:
        "../scripts/figure_06.py"


rule figure_07:
    input:
        curves_of(FIGURES_5["figure_07"]),
    output:
        ensure(figure_files("figure_07"), non_empty=True),
    log:
        f"{RESULTS}/logs/figure_07.log",
    benchmark:
        f"{RESULTS}/bench/figure_07.tsv"
    threads: 1
    params:
        config=part("robot", evaluation=["figure_07"]),
        entries=first_runs(FIGURES_5["figure_07"]),
        robot=CONTENT["robot"],
        code=code_of("figure_07"),
    script:
        "../scripts/figure_07.py"


rule figure_08:
    input:
        curves_of(FIGURES_5["figure_08"]),
    output:
        ensure(figure_files("figure_08"), non_empty=True),
    log:
        f"{RESULTS}/logs/figure_08.log",
    benchmark:
        f"{RESULTS}/bench/figure_08.tsv"
    threads: 1
    params:
        config=part("robot", evaluation=["figure_08"]) | sizes("figure_start_s"),
        entries=first_runs(FIGURES_5["figure_08"]),
        robot=CONTENT["robot"],
        code=code_of("figure_08"),
    script:
        "../scripts/figure_08.py"


rule figure_09:
    input:
        curves_of(FIGURES_5["figure_09"]),
    output:
        ensure(figure_files("figure_09"), non_empty=True),
    log:
        f"{RESULTS}/logs/figure_09.log",
    benchmark:
        f"{RESULTS}/bench/figure_09.tsv"
    threads: 1
    params:
        config=part("robot", evaluation=["figure_09"]) | sizes("figure_start_s"),
        entries=first_runs(FIGURES_5["figure_09"]),
        robot=CONTENT["robot"],
        code=code_of("figure_09"),
    script:
        "../scripts/figure_09.py"


rule figure_10:
    input:
        curves_of(*COLLISIONS.values()),
        scores=expand(
            f"{RESULTS}/scores/{{name}}.csv",
            name=[test["scenario"] for test in (*COLLISIONS.values(), FIGURES_5["figure_10"]["against"])],
        ),
    output:
        ensure([*figure_files("figure_10"), f"{FIGURES}/figure_10_bars.csv"], non_empty=True),
    log:
        f"{RESULTS}/logs/figure_10.log",
    benchmark:
        f"{RESULTS}/bench/figure_10.tsv"
    threads: 1
    params:
        config=part(
            "seed",
            "robot",
            "published",
            evaluation=["figure_10", "confidence", "bootstrap_draws"],
        ),
        entries={title: first_runs(test) for title, test in COLLISIONS.items()},
        robot=CONTENT["robot"],
        published=CONTENT["published"],
        code=code_of("figure_10"),
    script:
        "../scripts/figure_10.py"
