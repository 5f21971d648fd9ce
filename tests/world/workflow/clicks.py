"""What a reader does in Snakemake's report: choose in the menu, show a result, ask what it is."""

import json
from typing import Any

from browser import Browser, wait

MENU = "[...document.querySelectorAll('#app li a')].map((item) => item.textContent)"
ROWS = "[...document.querySelectorAll('#app tbody tr')].map((row) => row.cells[0].textContent)"
AGAIN_S = 2.0


def click(browser: Browser, script: str, then: str) -> None:
    """Click on the element that a script finds until another one holds: styles come late and move what is clicked."""

    def again() -> bool:
        browser.value(f"(() => {{const found = ({script}); if (found) found.id = 'target'}})()")
        browser.click("#target")
        browser.value("document.querySelector('#target')?.removeAttribute('id')")
        return wait(lambda: browser.value(then), AGAIN_S)

    browser.until(f"({script}) != null", True)
    assert wait(lambda: browser.value(then) or again()), then


def choose(browser: Browser, category: str) -> None:
    """Choose a category of results in the menu; from another one, which a late style may bring, go back first."""
    named = f"[...document.querySelectorAll('#app nav a')].find((link) => link.textContent === {json.dumps(category)})"
    back = "[...document.querySelectorAll('#app nav a')].find((link) => link.textContent === 'Results')"
    lines = f"document.querySelector('#app nav').innerText.split('\\n').includes({json.dumps(category)})"
    click(browser, f"{named} ?? {back}", f"document.querySelector('#app tbody tr') != null && {lines}")


def show(browser: Browser, name: str, kind: str) -> None:
    """Click on the eye beside a result, which opens an element of some kind, such as an `iframe`."""
    # The page on which the report opens is a frame too, and stays until a result takes its place.
    click(browser, _button(name, 0), f"document.querySelector('#app {kind}:not([srcdoc])') != null")


def explain(browser: Browser, name: str) -> str:
    """Click on the letter i beside a result and return its description."""
    click(browser, _button(name, 1), "document.body.innerText.includes('SNAKEMAKE RULE')")
    return " ".join(browser.value("document.body.innerText").split())


def _button(name: str, place: int) -> str:
    rows = "[...document.querySelectorAll('#app tbody tr')]"
    row = f"{rows}.find((row) => row.cells[0].textContent === {json.dumps(name)})"
    return f"{row}?.querySelectorAll('td:last-child a')[{place}]"


def text_of_frame(browser: Browser) -> str:
    """Return the text of an HTML result, once its frame has loaded it."""
    wait(lambda: _frame(browser)["url"].startswith("data:"))
    world = browser.tell("Page.createIsolatedWorld", frameId=_frame(browser)["id"])["executionContextId"]
    text = "document.readyState === 'complete' ? document.body.innerText : ''"
    asked = {"expression": text, "contextId": world, "returnByValue": True}
    return wait(lambda: browser.tell("Runtime.evaluate", **asked)["result"]["value"])


def _frame(browser: Browser) -> dict[str, Any]:
    trees = browser.tell("Page.getFrameTree")["frameTree"]["childFrames"]
    return next((tree["frame"] for tree in trees if tree["frame"]["url"].startswith("data:")), trees[0]["frame"])
