"""The committed snapshot of the default scale's results: writing it, and finding what differs from it.

`./reproduce` calls `python -m experiments.site.snapshot {snapshot,compare,verify}`.
"""

import gzip
import logging
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from fnmatch import fnmatch
from itertools import zip_longest
from pathlib import Path

from PIL import Image

from experiments.evaluation.measure.story import StoredPush
from experiments.evaluation.report.demo import lines_of, title_of
from experiments.evaluation.report.demo_data import copy_demo
from experiments.evaluation.report.manifest import differences, file_hash
from experiments.evaluation.report.paper import missing_packages, unfit_words
from experiments.plan.demo import FOLDER
from experiments.plan.detection import all_detections
from experiments.plan.dry_run import dry_run
from experiments.plan.plan import make_plan
from experiments.plan.prices import RATES
from experiments.plan.product import PAPER_NOTE
from experiments.plan.reactions import all_reactions
from experiments.plan.work import works_of
from experiments.running.accounts import read_account
from experiments.running.logs import LOGS
from experiments.running.one_run import held_folder
from experiments.running.words import MAIN, manifest_of, results_parser, scale_given
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from experiments.site.blocks import with_block
from experiments.site.folder_page import write_page
from experiments.site.model_card import CARD, card
from experiments.site.rates import measured
from experiments.site.readme import CLAIMS, check_told, tell_readme
from experiments.site.registered import check_registered, registration
from experiments.site.single_rows import write_single_rows
from experiments.site.walked import SEEDS, check_seeds, read_history, walked, write_history
from mobnet.core.code import CHANGED, UNKNOWN, changed_between, commit, provenance
from mobnet.core.errors import DataError, MobnetError
from mobnet.core.files import atomic_path, read_json, read_text, write_json, write_text
from mobnet.core.heartbeat import heartbeat
from mobnet.core.printed import to_output
from mobnet.core.rows import read_texts

log = logging.getLogger(__name__)

TABLES = Path("tables")
FIGURES = Path("figures")
SNAPSHOT = Path("docs/results")
DEMO = Path("docs/demo")
DEMO_PAGE = Path("docs/demo.md")
RESULTS = Path("results/default")
FURTHER = tuple(RESULTS / name for name in ("compute.md", "compute.tex", "explore.html"))
PAPER = Path("paper/main.pdf")
UP_TO_DATE = "Nothing to be done"  # by which Snakemake says that no job would run
DRAWN = "figures"  # folder of the snapshot with the CSVs of figures, compressed
# A figure has a few colours and, where lines are smoothed, many between them: these are what can be told apart least.
COLOURS = 64
WHITE = (255, 255, 255)
PICTURES = (".png", ".webp")  # SVG and PDF: ./reproduce draw
TEXTS = (".md", ".tex")  # of a table
WORDS = (  # files that may change between a run and its snapshot; of claims a fingerprint holds all but words
    *("*.md", "*.md.j2", "*.rst", "paper/*.tex", "paper/*.bib", "tests/*", "docs/results/*", "configs/claims.yaml"),
    *("CITATION.cff", "codemeta.json", ".zenodo.json"),
)
NOTED = ("recordings", "motions", "networks")  # folders of results whose notes name the commit that made them
KEYS = (  # columns that name a row; the others are results
    "scenario",
    "level",
    "method",
    "joint",
    "metric",
    "claim",
    "tolerance",
    "set",
    "quantity",
    "part",
    "command",
    "bin_from",
    "measure",
    "limb",
    "test",
    "pushed",
    "share",
    "unit",
    "score",
    "outcome",
    "detector",
    "leg",
    "kind",
    "cell",
    "case",
    "wrench",
    "thresholds",
    "wait_s",
    "feed_forward",
    "event",
    "robot",
    "label",
    "phase",
    "row",
)
CLAIMS_TABLE = f"{CLAIMS}: "  # before what differs in the table of claims
KEYS_OF = {"hourly": ("walks",)}  # a number in other tables
Rows = dict[tuple[str, ...], dict[str, str]]


def check_run(results: Path, manifest: Path) -> str:
    """Check that results are those of the present commit, whether or not the run was stopped and went on.

    A text is often mended once its numbers are there: a job or a file may be of an earlier commit, from which the
    present one differs in words alone.

    Returns:
        the commit of the run, which made most of the files.

    Raises:
        DataError: one line for each fault: tracked files were changed, another commit ran a job or made a file, or a
            file is not as the run wrote it.
    """
    head = commit()
    faults = differences(manifest)
    if head == UNKNOWN or head.endswith(CHANGED):
        faults.append(f"commit {head}: is not accepted; accepted: a checkout without changed files")
    made = made_by(results)
    for found in sorted(set(made.values()) - {head}):
        changed = changed_between(found, head)
        numbers = [] if changed is None else [name for name in changed if not is_words(name)]
        if changed is not None and not numbers:
            continue
        first, *others = [path for path, name in made.items() if name == found]
        beside = f" ({len(others)} further files)" if others else ""
        why = f", from which {numbers[0]} differs" if numbers else ""
        faults.append(f"{first}: commit {found} is not accepted; accepted: {head}{why}{beside}")
    if faults:
        raise DataError("\n".join(faults))
    return Counter(made.values()).most_common(1)[0][0] if made else head


def is_words(name: str) -> bool:
    """Return whether a file of the repository holds words alone, and no number or code that makes a result."""
    return any(fnmatch(name, pattern) for pattern in WORDS)


def made_by(results: Path) -> dict[Path, str]:
    """Return the accounts of jobs and the notes of files in results -> the commit that they name."""
    accounts = {path: read_account(path).commit for path in sorted((results / LOGS).rglob("*.json"))}
    notes: list[Path] = []
    for folder in NOTED:
        notes += sorted(results.glob(f"**/{folder}/**/*.json"))
    return accounts | {note: read_json(note).get("provenance", {}).get("commit", UNKNOWN) for note in notes}


def check_fingerprints(*words: str) -> None:
    """Check by a dry run that no job would run again: arguments, code and inputs of each are as they were.

    Args:
        words: targets and options of the run.

    Raises:
        DataError: a job would run again, or nobody can say.
    """
    run = [sys.executable, "-m", "snakemake", "--cores", "1", "-n", *words]
    done = subprocess.run(run, capture_output=True, text=True, check=False)
    told = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
    if done.returncode:
        raise DataError(f"{' '.join(words)}: cannot be planned: {told[-1].strip() if told else done.returncode}")
    if not any(UP_TO_DATE in line for line in told):
        count = next((line.split()[-1] for line in told if line.startswith("total ")), "some")
        text = f"{count} jobs would run again, which is not accepted; accepted: what this configuration and code make"
        raise DataError(f"{' '.join(words)}: {text}")


def write_snapshot(settings: Settings, tables: Path, figures: Path, further: Sequence[Path], out: Path) -> None:
    """Copy a scale's tables (CSV, Markdown, TeX), figures (PNG, WebP, CSV) and further files, and note their origin.

    Tables and figures of an earlier snapshot that are made no longer are removed. The table of compute differs from run
    to run, so it is stored without a CSV to be compared.

    Raises:
        DataError: there is no table to copy, or a file is missing.
    """
    numbers = sorted(tables.glob("*.csv"))
    drawings: list[Path] = []
    for ending in PICTURES:
        drawings += figures.glob(f"*{ending}")
    pictures = sorted(drawings)
    found = [*numbers, *pictures, *further]
    for ending in TEXTS:
        found += [path.with_suffix(ending) for path in numbers]
    if not numbers:
        raise DataError(f"{tables}: holds no CSV; ./reproduce all makes them")
    missing = [path for path in found if not path.is_file()]
    if missing:
        raise DataError(f"{missing[0]}: file is missing; ./reproduce all makes it")
    for source in found:
        if source.suffix == ".png":
            save_small(source, out / source.name)
        else:
            with atomic_path(out / source.name) as temporary:
                shutil.copyfile(source, temporary)
    drawn = sorted(figures.glob("*.csv"))
    for source in drawn:
        store_drawn(source, out)
    kept = {out / source.name for source in numbers} | {out / DRAWN / f"{source.name}.gz" for source in drawn}
    for path in {*out.glob("*.csv"), *(out / DRAWN).glob("*.csv.gz")} - kept:
        # A table that is made no longer takes its texts along, the numbers of a figure take its pictures.
        shown = TEXTS if path.parent == out else PICTURES
        for gone in (path, *(out / f"{path.name.partition('.')[0]}{ending}" for ending in shown)):
            gone.unlink(missing_ok=True)
    write_json(out / "provenance.json", {"scale": settings.scale, **provenance()})
    log.info("%s: %d files", out, len(found))


def save_small(source: Path, out: Path) -> None:
    """Store a picture as a PNG of `COLOURS` colours on white; equal pictures give equal files."""
    with Image.open(source) as image:
        picture = image.convert("RGBA")
    paper = Image.new("RGBA", picture.size, WHITE)
    flat = Image.alpha_composite(paper, picture).convert("RGB")
    # Without dithering: it would put dots into even areas.
    few = flat.quantize(COLOURS, kmeans=1, dither=Image.Dither.NONE)
    with atomic_path(out) as temporary:
        few.save(temporary, "png", optimize=True)


def check_paper(pdf: Path) -> None:
    """Check that the text of a run's paper fits its results, where TeX set it.

    Raises:
        DataError: it does not; one line with what is to be mended.
    """
    if unfit := unfit_words(pdf.with_name(PAPER_NOTE)):
        remedy = f"mend the words of {pdf.with_suffix('.tex')}, and call ./reproduce all"
        raise DataError(f"{pdf}: the text does not fit its results: {'; '.join(unfit)}; {remedy}")


def store_paper(pdf: Path, out: Path) -> None:
    """Store the paper of a run; where it made none, as TeX was missing, an older one goes."""
    stored = out / "paper.pdf"
    if pdf.is_file():
        with atomic_path(stored) as temporary:
            shutil.copyfile(pdf, temporary)
    else:
        stored.unlink(missing_ok=True)


def store_drawn(source: Path, out: Path) -> None:
    """Store the CSV of a figure in a snapshot, compressed."""
    with atomic_path(out / DRAWN / f"{source.name}.gz") as temporary:
        temporary.write_bytes(gzip.compress(source.read_bytes(), mtime=0))


def tell_demo(stored: StoredPush, page: Path) -> None:
    """Write into the page of the demo what it prints."""
    push = stored.scene({method: stored.estimate(method) for method in stored.story.methods})
    said = "\n".join(["```", title_of(stored), *lines_of(stored, push), "```"])
    write_text(page, with_block(read_text(page), "demo", said, page))


def compare_snapshot(snapshot: Path, tables: Path, figures: Path) -> list[str]:
    """Return one line for each cell, row, table or figure in which present results differ from a snapshot."""
    stored = sorted(snapshot.glob("*.csv"))
    if not stored:
        raise DataError(f"{snapshot}: holds no CSV; ./reproduce snapshot stores them")
    told: list[str] = []
    for path in stored:
        told += table_differences(path, tables / path.name)
    for path in sorted((snapshot / DRAWN).glob("*.csv.gz")):
        told += figure_differences(path, figures / path.stem)
    return told


def figure_differences(old: Path, new: Path) -> Iterator[str]:
    """Yield one line where the CSV of a figure differs: how many of its rows do."""
    if not new.exists():
        yield f"{new}: file is missing; ./reproduce all makes it"
        return
    before = gzip.decompress(old.read_bytes()).decode().splitlines()
    after = read_text(new).splitlines()
    count = sum(was != now for was, now in zip_longest(before, after))
    if count:
        yield f"{new}: {count} of {max(len(before), len(after))} rows differ"


def table_differences(old: Path, new: Path) -> Iterator[str]:
    """Yield one line for each cell or row in which a table differs, old value first."""
    if not new.exists():
        yield f"{new}: file is missing; ./reproduce all makes it"
        return
    before = read_keyed(old)
    after = read_keyed(new)
    for key in before | after:
        where = f"{new.name}: {' '.join(key)}"
        if key not in after:
            yield f"{where}: row is gone"
        elif key not in before:
            yield f"{where}: row is new"
        else:
            yield from (f"{where}: {text}" for text in cell_differences(before[key], after[key]))


def cell_differences(old: Mapping[str, str], new: Mapping[str, str]) -> Iterator[str]:
    """Yield `column old -> new` for each column in which two rows differ."""
    for column in dict.fromkeys([*old, *new]):
        was = old.get(column, "no such column")
        now = new.get(column, "no such column")
        if was != now:
            yield f"{column} {was} -> {now}"


def read_keyed(path: Path) -> Rows:
    """Read a tidy CSV as (values of the naming columns) -> row."""
    keys = (*KEYS, *KEYS_OF.get(path.stem, ()))
    rows: Rows = {}
    for row in read_texts(path):
        rows[tuple(row[key] for key in keys if key in row)] = row
    return rows


def store(manifest: Path) -> None:
    """Store the run's results as the published ones, and renew what the documents say of them.

    Raises:
        DataError: the results are not those of the present commit, a published run with other methods walked their
            seeds, or a file is missing or damaged.
    """
    settings = load_settings()
    # Everything is checked before the first file is replaced: a refused snapshot leaves the old one whole.
    check_registered(settings)
    ran = check_run(RESULTS, manifest)
    check_fingerprints("all")
    plan = make_plan(settings, with_pdf=not missing_packages())
    published = read_history(SEEDS)
    run = walked(plan.files, ran)
    check_seeds(run, published)
    check_told(TABLES)
    check_paper(PAPER)
    write_snapshot(settings, TABLES, FIGURES, FURTHER, SNAPSHOT)
    note_entry(SNAPSHOT, "registered", registration())
    if ran != commit():
        note_entry(SNAPSHOT, "commit", ran)
        note_entry(SNAPSHOT, "words", commit())
    store_paper(PAPER, SNAPSHOT)
    detections = all_detections(plan.files)
    reactions = all_reactions(plan.files)
    write_single_rows(detections, reactions, tuple(settings.reaction.cases), SNAPSHOT)
    copy_demo(RESULTS / FOLDER, DEMO)
    tell_demo(StoredPush(DEMO, settings), DEMO_PAGE)
    write_text(CARD, card(DEMO, SNAPSHOT))
    write_history(SEEDS, [*published, run])
    jobs = map(read_account, sorted((RESULTS / LOGS).rglob("*.json")))
    works = works_of(plan, dry_run(["all"], from_nothing=True))
    write_json(RATES, measured(settings.scale, works, jobs).model_dump())
    # README and page of the folder tell what was just stored, so they come last.
    tell_readme(SNAPSHOT)
    write_page(SNAPSHOT)


def note_entry(published: Path, name: str, value: object) -> None:
    """Put an entry into the note of published results, such as how a part was made again after their run."""
    note = published / "provenance.json"
    write_json(note, {**read_json(note), name: value})


def run_renewal(renew: Callable[[], None], told: logging.Logger) -> int:
    """Make a part of the published results again; return the exit status. Only what `told` logs is shown."""
    logging.basicConfig(level=logging.WARNING, format="%(message)s", stream=sys.stdout)
    told.setLevel(logging.INFO)
    try:
        renew()
    except MobnetError as error:
        told.error("%s", error)
        return 1
    return 0


def main(words: list[str]) -> int:
    """Run one of the commands and return the exit status: 0 if nothing differs."""
    command, *others = words
    options = results_parser(command).parse_args(others)
    output = to_output()
    compares = command == "compare"
    scale = scale_given(options.config)
    manifest = manifest_of(scale) if compares or options.manifest is None else options.manifest
    try:
        if scale != MAIN and command != "verify":
            raise DataError(f"{SNAPSHOT}: holds the scale {MAIN}; accepted: {command} without scale={scale}")
        with heartbeat():
            if command == "snapshot":
                with held_folder(Path.cwd(), words):  # tables change while a run goes on
                    store(manifest)
                return 0
            found = compare_snapshot(SNAPSHOT, TABLES, FIGURES) if compares else differences(manifest)
    except MobnetError as error:
        log.error("%s", error)
        return 1
    for line in found:
        log.info("%s", line)
    if compares and found:
        turned = sum(" verdict " in line for line in found if line.startswith(CLAIMS_TABLE))
        log.info("%sverdicts that differ: %d", CLAIMS_TABLE, turned)
    listed = SNAPSHOT if compares else f"{manifest} ({file_hash(manifest)})"
    log.info("%s: %s", listed, f"{len(found)} differences" if found else "no difference")
    return 1 if found or output.is_cut else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
