# Networks, their ablations and all methods side by side: Table 1, Figures 17, 18 and 20, section 6.1 in numbers.

FIGURE_17, VARIANTS = settings["evaluation"]["figure_17"], settings["evaluation"]["kinds"]["variants"]


rule table_01:
    output:
        ensure(
            expand(f"{TABLES}/table_01.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/table_01.log",
    benchmark:
        f"{RESULTS}/bench/table_01.tsv"
    threads: 1
    params:
        config=part(
            "seed",
            "robot",
            "published",
            "learning",
            "networks",
            methods=[settings["evaluation"]["table_01"]["method"]],
            evaluation=["table_01"],
        ),
        robot=CONTENT["robot"],
        published=CONTENT["published"],
        code=code_of("table_01"),
    script:
        "../scripts/table_01.py"


rule figure_17:
    input:
        courses(network_folders(FIGURE_17["methods"], FIGURE_17["limb"])),
    output:
        ensure(figure_files("figure_17"), non_empty=True),
    log:
        f"{RESULTS}/logs/figure_17.log",
    benchmark:
        f"{RESULTS}/bench/figure_17.tsv"
    threads: 1
    params:
        folders=network_folders(FIGURE_17["methods"], FIGURE_17["limb"]),
        code=code_of("figure_17"),
    script:
        "../scripts/figure_17.py"


rule kinds:
    input:
        courses(network_folders(FIGURE_17["methods"] + VARIANTS, FIGURE_17["limb"])),
    output:
        ensure(
            expand(f"{TABLES}/kinds.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/kinds.log",
    benchmark:
        f"{RESULTS}/bench/kinds.tsv"
    threads: 1
    params:
        config=part(
            "seed",
            "published",
            evaluation=["figure_17", "kinds", "confidence", "bootstrap_draws"],
        ),
        folders=network_folders(FIGURE_17["methods"] + VARIANTS, FIGURE_17["limb"]),
        published=CONTENT["published"],
        code=code_of("kinds"),
    script:
        "../scripts/kinds.py"


rule figure_18:
    input:
        scores=expand(f"{RESULTS}/scores/{{name}}.csv", name=FIGURE_18["panels"]),
    output:
        ensure(figure_files("figure_18"), non_empty=True),
    log:
        f"{RESULTS}/logs/figure_18.log",
    benchmark:
        f"{RESULTS}/bench/figure_18.tsv"
    threads: 1
    params:
        config=part(
            "seed",
            "robot",
            evaluation=["figure_18", "confidence", "bootstrap_draws"],
        ),
        robot=CONTENT["robot"],
        code=code_of("figure_18"),
    script:
        "../scripts/figure_18.py"


rule figure_20:
    input:
        [name for size in sizes_of_networks() for name in courses(size["folders"])],
    output:
        ensure(figure_files("figure_20"), non_empty=True),
    log:
        f"{RESULTS}/logs/figure_20.log",
    benchmark:
        f"{RESULTS}/bench/figure_20.tsv"
    threads: 1
    params:
        entries=sizes_of_networks(),
        code=code_of("figure_20"),
    script:
        "../scripts/figure_20.py"


rule methods:
    input:
        scores=expand(
            f"{RESULTS}/scores/{{name}}.csv",
            name=[test["scenario"] for test in settings["evaluation"]["methods"]],
        ),
    output:
        ensure(
            expand(f"{TABLES}/methods.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
    log:
        f"{RESULTS}/logs/methods.log",
    benchmark:
        f"{RESULTS}/bench/methods.tsv"
    threads: 1
    params:
        config=part("seed", evaluation=["methods", "confidence", "bootstrap_draws"]),
        code=code_of("methods"),
    script:
        "../scripts/methods.py"
