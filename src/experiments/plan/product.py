"""What a job of a table, a figure or a text is: the call that it makes, the files that it reads and those it writes."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from experiments.plan.files import Files
from experiments.plan.heads import caption_of, head_of
from experiments.settings.asked import tests_in
from experiments.settings.evaluation import Evaluation
from experiments.settings.published import Published
from experiments.settings.runs import Statistics
from experiments.settings.settings import Settings
from mobnet.core.code import ROOT, code_hash
from mobnet.core.joints import JointLayout

SCRIPT = ROOT / "workflow" / "scripts" / "product.py"  # that makes any product
PAPER_NOTE = "build.json"  # beside the paper: how it was set
TABLE, FIGURE = ("csv", "tex", "md"), ("pdf", "svg", "png", "csv")  # endings of a table's and of a figure's files
Arguments = Mapping[str, object]  # of a function, by the names of its parameters
# Imports the function that makes a product, and returns it. The plan holds functions of this kind, as the import of
# torch, MuJoCo or matplotlib takes a second and belongs to the job.
Late = Callable[[], Callable[..., None]]


@dataclass(frozen=True)
class Call:
    """A call of a function that is imported late, with its arguments: sections, names and paths."""

    late: Late
    arguments: Arguments

    @property
    def name(self) -> str:
        """Where the job finds the function that imports late, as `module:name`."""
        return f"{self.late.__module__}:{self.late.__name__}"

    def run(self) -> None:
        """Import the function and call it."""
        self.late()(**self.arguments)


@dataclass(frozen=True)
class Product:
    """A table, a figure, or a part of the paper or report: the files that one job makes, and how it makes them.

    Attributes:
        name: its name.
        call: the call of its function.
        inputs: what it reads.
        outputs: files, or the one folder, that it makes.
        modules: those that the function imports by name only.
    """

    name: str
    call: Call
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    modules: tuple[str, ...] = ()

    @property
    def function(self) -> str:
        """Where the job finds the function that imports the one it calls."""
        return self.call.name

    @property
    def arguments(self) -> dict[str, object]:
        """What the function gets; Snakemake compares a dictionary with that of the last run."""
        return dict(self.call.arguments)

    @property
    def code(self) -> str:
        """Hash of the code behind it."""
        return code_hash(SCRIPT, self.call.name, *self.modules)

    @property
    def heads(self) -> dict[str, str]:
        """Table as Markdown -> what stands above its rows, of those that have a caption."""
        heads: dict[str, str] = {}
        for output in self.outputs:
            caption = caption_of("tables", Path(output).stem)
            if output.endswith(".md") and caption.is_file():
                heads[output] = head_of(caption.read_text(encoding="utf-8"))
        return heads

    @property
    def rule(self) -> str:
        """The rule that makes it: products with files of the same layout share one, others have one of their name."""
        places = [(Path(output).parts[0], Path(output).name) for output in self.outputs]
        drawn = [("figures", f"{self.name}.{ending}") for ending in FIGURE]
        bars = [("figures", f"{self.name}_bars.csv")]
        written = [("tables", f"{self.name}.{ending}") for ending in TABLE]
        layouts = {
            "table": written,
            "figure": drawn,
            "figure_with_bars": [*drawn, *bars],
            "figure_with_table": [*drawn, *written],
        }
        return next((rule for rule, layout in layouts.items() if places == layout), self.name)


@dataclass(frozen=True)
class Folders:
    """Where a scale's products stand; `results` has everything but tables, figures and the paper."""

    results: Path
    tables: Path
    figures: Path
    paper: Path
    manifest: Path

    @property
    def captions(self) -> Path:
        """Folder of the captions of tables and figures in which fields are numbers of this scale."""
        return self.results / "captions"

    def caption(self, written: Path) -> Path:
        """Return the caption with numbers of one as it was written; those of other pages of the report have none."""
        kind = written.parent.name
        return self.captions / kind / written.name if kind in ("tables", "figures") else written


@dataclass(frozen=True)
class Context:
    """What the arguments of any product are taken from: the configuration of a scale, its files and its folders."""

    settings: Settings
    files: Files
    folders: Folders

    @property
    def evaluation(self) -> Evaluation:
        """Sections of tables and figures."""
        return self.settings.evaluation

    @property
    def statistics(self) -> Statistics:
        """How intervals are made."""
        return self.settings.evaluation.statistics

    @property
    def published(self) -> Published:
        """Numbers of the paper."""
        return self.settings.published

    @cached_property
    def layout(self) -> JointLayout:
        """The robot's joints."""
        return self.settings.layout

    def scores(self, section: object) -> tuple[Path, ...]:
        """Return the scores of the tests that a section, or several of them, names, at the levels that it names."""
        return self.files.scores(tests_in(self.settings, section))

    def start_s(self, section_s: float) -> float:
        """Return the start of a gait cycle in a recording [s], which a scale may replace; a section names another."""
        shortened = self.settings.sizes.figure_start_s
        return section_s if shortened is None else shortened


@dataclass(frozen=True)
class PaperItem:
    """The row of a table or a figure: what makes it, what its function gets, and which files it writes.

    The inputs of its job are the files among what the function gets.

    Attributes:
        late: imports its function; the item has the name of this one.
        given: returns what the function gets, but the folders that it writes into.
        table: whether it writes a table; its function gets `table_dir`.
        figure: whether it draws a figure; its function gets `figure_dir`.
        further: names of more figures that it draws.
        bars: whether its figure has a second CSV file, of its bars.
        kept: whether it shows a file of the repository, its argument `kept`; it is left out where there is none.
        entry: its name, where several items share a function.
    """

    late: Late
    given: Callable[[Context], Arguments]
    table: bool = False
    figure: bool = False
    further: tuple[str, ...] = ()
    bars: bool = False
    kept: bool = False
    entry: str = ""

    @property
    def name(self) -> str:
        """Its name, which is that of its files."""
        return self.entry or self.late.__name__

    @property
    def pictures(self) -> tuple[str, ...]:
        """Names of the files of its figures."""
        return (self.name, *self.further) if self.figure else ()

    def written_into(self, folders: Folders) -> dict[str, Path]:
        """Return the folders that its function gets beside what is given."""
        places: dict[str, Path] = {}
        if self.table:
            places["table_dir"] = folders.tables
        if self.figure:
            places["figure_dir"] = folders.figures
        return places
