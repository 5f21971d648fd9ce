"""The README as a code host shows it: nothing of it is cut off."""

from pathlib import Path

import pytest
from browser import Browser, with_browser
from markdown_it import MarkdownIt

ROOT = Path(__file__).parents[3]
HEIGHT, COLUMN = 900, 830  # of the window, and width of the column of text on a code host [px]
STYLE = f"""
body {{ margin: 0; font: 16px/1.5 sans-serif; }}
main {{ box-sizing: border-box; max-width: {COLUMN}px; margin: 0 auto; padding: 32px; }}
h1 {{ font-size: 2em; line-height: 1.25; margin: 0 0 16px; padding-bottom: 0.3em; border-bottom: 1px solid; }}
p, pre, ul {{ margin: 0 0 16px; }}
pre {{ padding: 16px; font: 13.6px/1.45 monospace; overflow: auto; }}
img {{ max-width: 100%; }}
table {{ display: block; overflow: auto; border-collapse: collapse; }}
th, td {{ padding: 6px 13px; border: 1px solid; }}
"""


@pytest.fixture
def shown(running: Browser, tmp_path: Path) -> Browser:
    """The README as a page, its picture loaded."""
    body = MarkdownIt("commonmark", {"html": True}).enable("table").render((ROOT / "README.md").read_text())
    page = tmp_path / "readme.html"
    head = f'<base href="{ROOT.as_uri()}/"><meta name="viewport" content="width=device-width"><style>{STYLE}</style>'
    page.write_text(f"<!doctype html>{head}<main>{body}</main>")
    running.go(page.as_uri())
    running.until("document.querySelector('img').naturalWidth", 960)
    return running


@with_browser
def test_on_a_telephone_nothing_is_wider_than_the_screen(shown: Browser) -> None:
    """Tables and commands scroll by themselves."""
    with shown.sized(400, HEIGHT):
        assert shown.value("document.documentElement.scrollWidth") <= 400
