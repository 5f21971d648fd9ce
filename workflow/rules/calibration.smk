# How far the networks' standard deviations can be trusted: held out, in tests, under collision.


rule calibration:
    input:
        [arrays(test["runs"], "recording", "residual", "estimate") for test in calibration_tests()],
        notes=networks("run.json"),
    output:
        ensure(
            expand(f"{TABLES}/calibration.{{ending}}", ending=["csv", "tex", "md"]),
            non_empty=True,
        ),
        figure=ensure(figure_files("calibration"), non_empty=True),
    log:
        f"{RESULTS}/logs/calibration.log",
    benchmark:
        f"{RESULTS}/bench/calibration.tsv"
    threads: 1
    params:
        config=part("seed", "robot", evaluation=["calibration", "coverage", "confidence", "bootstrap_draws"]),
        tests=calibration_tests(),
        robot=CONTENT["robot"],
        code=code_of("calibration"),
    script:
        "../scripts/calibration.py"
