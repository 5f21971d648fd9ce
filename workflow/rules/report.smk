# The paper with its numbers, and the list of every result file.


rule numbers:
    input:
        tables=expand(f"{TABLES}/{{name}}.csv", name=settings["evaluation"]["tables"]),
        claims=f"{TABLES}/claims.csv",
    output:
        ensure(f"{TABLES}/numbers.tex", non_empty=True),
    log:
        f"{RESULTS}/logs/numbers.log",
    benchmark:
        f"{RESULTS}/bench/numbers.tsv"
    threads: 1
    params:
        config=part("scale", "rates", "sizes"),
        code=code_of("numbers"),
    script:
        "../scripts/numbers.py"


rule deviations:
    input:
        "docs/deviations.md",
    output:
        ensure(f"{TABLES}/deviations.tex", non_empty=True),
    log:
        f"{RESULTS}/logs/deviations.log",
    benchmark:
        f"{RESULTS}/bench/deviations.tsv"
    threads: 1
    params:
        code=code_of("deviations"),
    script:
        "../scripts/deviations.py"


rule paper:
    input:
        main="paper/main.tex",
        references="paper/refs.bib",
        tables=expand(f"{TABLES}/{{name}}.tex", name=[*TABLE_NAMES, "numbers", "deviations"]),
        figures=expand(f"{FIGURES}/{{name}}.pdf", name=FIGURE_NAMES),
        compute="docs/results/compute.tex",  # of the committed run: this one's differs each time
    output:
        ensure(f"{PAPER}/build.json", non_empty=True),
        ensure([shown(name, "paper") for name in PDF], non_empty=True),
    log:
        f"{RESULTS}/logs/paper.log",
    benchmark:
        f"{RESULTS}/bench/paper.tsv"
    threads: 1
    params:
        config=part("scale"),
        code=code_of("paper"),
    script:
        "../scripts/paper.py"


rule manifest:
    input:
        PRODUCTS,
    output:
        ensure(MANIFEST, non_empty=True),
    log:
        f"{RESULTS}/logs/manifest.log",
    benchmark:
        f"{RESULTS}/bench/manifest.tsv"
    threads: 1
    params:
        code=code_of("manifest"),
    script:
        "../scripts/manifest.py"
