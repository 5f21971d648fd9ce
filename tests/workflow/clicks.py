"""What a reader does in Snakemake's report: choose in the menu, show a result, ask what it is."""

from __future__ import annotations

import json
import time
from typing import Any

from browser import WAIT_S, Browser

MENU = "[...document.querySelectorAll('#app li a')].map((item) => item.textContent)"
ROWS = "[...document.querySelectorAll('#app tbody tr')].map((row) => row.cells[0].textContent)"
AGAIN_S = 2.0


def click(browser: Browser, script: str, then: str) -> None:
    """Click on the element that a script finds until another one holds: styles come late and move what is clicked."""
    browser.until(f"({script}) != null", True)
    end = time.monotonic() + WAIT_S
    while not browser.value(then) and time.monotonic() < end:
        browser.value(f"(() => {{const found = ({script}); if (found) found.id = 'target'}})()")
        browser.click("#target")
        browser.value("document.querySelector('#target')?.removeAttribute('id')")
        again = time.monotonic() + AGAIN_S
        while not browser.value(then) and time.monotonic() < again:
            time.sleep(0.05)
    assert browser.value(then), then


def choose(browser: Browser, category: str) -> None:
    """Choose a category of results in the menu."""
    item = f"[...document.querySelectorAll('#app li a')].find((item) => item.textContent === {json.dumps(category)})"
    click(browser, item, "document.querySelector('#app tbody tr') != null")


def show(browser: Browser, name: str, kind: str) -> None:
    """Click on the eye beside a result, which opens an element of some kind, such as an `iframe`."""
    click(browser, _button(name, 0), f"document.querySelector('#app {kind}') != null")


def explain(browser: Browser, name: str) -> str:
    """Click on the letter i beside a result and return what is told of it."""
    click(browser, _button(name, 1), "document.body.innerText.includes('SNAKEMAKE RULE')")
    return " ".join(browser.value("document.body.innerText").split())


def _button(name: str, place: int) -> str:
    """Return a script that finds one of the two buttons beside a result."""
    rows = "[...document.querySelectorAll('#app tbody tr')]"
    row = f"{rows}.find((row) => row.cells[0].textContent === {json.dumps(name)})"
    return f"{row}?.querySelectorAll('td:last-child a')[{place}]"


def text_of_frame(browser: Browser) -> str:
    """Return the text of an HTML result, once its frame has loaded it."""
    end = time.monotonic() + WAIT_S
    while not (frame := _frame(browser))["url"].startswith("data:") and time.monotonic() < end:
        time.sleep(0.05)
    world = browser.tell("Page.createIsolatedWorld", frameId=frame["id"])["executionContextId"]
    script = "document.readyState === 'complete' ? document.body.innerText : ''"
    text = ""
    while not text and time.monotonic() < end:
        found = browser.tell("Runtime.evaluate", expression=script, contextId=world, returnByValue=True)
        text = found["result"]["value"]
    return text


def _frame(browser: Browser) -> dict[str, Any]:
    """Return the frame of an HTML result."""
    (tree,) = browser.tell("Page.getFrameTree")["frameTree"]["childFrames"]
    return tree["frame"]
