"""A headless browser for tests of pages."""

import json
import os
import select
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any, TypeVar

import pytest
from patience import HANGS_S

BROWSER = shutil.which("chromium") or shutil.which("google-chrome")
with_browser = pytest.mark.skipif(BROWSER is None, reason="no browser is installed: apt-get install chromium")
Answer = TypeVar("Answer")


def wait(ask: Callable[[], Answer], seconds: float = HANGS_S) -> Answer:
    """Ask until the answer is true or the time is over, and return the last answer."""
    end = time.monotonic() + seconds
    while not (answer := ask()) and time.monotonic() < end:
        time.sleep(0.02)
    return answer


class Browser:
    """A headless browser that is controlled over a pipe (Chrome DevTools protocol), and the events it reported."""

    def __init__(self, program: str, folder: Path) -> None:
        read, self._write = os.pipe()
        self._read, write = os.pipe()
        words = [
            program, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
            "--disable-background-networking", f"--user-data-dir={folder}", "--remote-debugging-pipe",
        ]  # fmt: skip
        self.process = subprocess.Popen(
            ["bash", "-c", f'exec "$@" 3<&{read} 4>&{write}', "bash", *words],
            pass_fds=(read, write), stderr=subprocess.DEVNULL,
        )  # fmt: skip
        os.close(read)
        os.close(write)
        self.events = []
        self._rest, self._number, self._session = b"", count(1), {}
        target = self.tell("Target.createTarget", url="about:blank")["targetId"]
        attached = self.tell("Target.attachToTarget", targetId=target, flatten=True)
        self._session = {"sessionId": attached["sessionId"]}
        for part in ("Page", "Runtime", "Network"):
            self.tell(f"{part}.enable")

    def close(self) -> None:
        os.close(self._write)
        self.process.wait(HANGS_S)
        os.close(self._read)

    def tell(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send a command and return its result."""
        number = next(self._number)
        words = {"id": number, "method": method, "params": parameters, **self._session}
        os.write(self._write, json.dumps(words).encode() + b"\0")
        while (answer := self._message()).get("id") != number:
            self.events.append(answer)
        assert "error" not in answer, answer
        return answer["result"]

    def _message(self) -> dict[str, Any]:
        while b"\0" not in self._rest:
            assert select.select([self._read], [], [], HANGS_S)[0], "the browser does not answer"
            part = os.read(self._read, 1 << 16)
            assert part, "the browser has gone"
            self._rest += part
        message, self._rest = self._rest.split(b"\0", 1)
        return json.loads(message)

    def value(self, script: str) -> Any:
        return self.tell("Runtime.evaluate", expression=script, returnByValue=True)["result"].get("value")

    def until(self, script: str, wanted: Any) -> None:
        wait(lambda: self.value(script) == wanted)
        seen = self.value(script)
        assert seen == wanted, f"{script}: {seen}, expected {wanted}"

    def go(self, address: str) -> None:
        """Load a page afresh."""
        self.tell("Page.navigate", url="about:blank")
        self.until("location.href + document.readyState", "about:blankcomplete")
        self.tell("Page.navigate", url=address)
        self.until("location.protocol + document.readyState", "file:complete")

    @contextmanager
    def sized(self, width: int, height: int = 900, *, mobile: bool = False) -> Iterator[None]:
        """Give the window a size [px] for a while."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile}
        self.tell("Emulation.setDeviceMetricsOverride", **size)
        try:
            yield
        finally:
            self.tell("Emulation.clearDeviceMetricsOverride")

    @contextmanager
    def without_scripts(self) -> Iterator[None]:
        """Load the page again without its scripts, and allow them afterwards."""
        self.tell("Emulation.setScriptExecutionDisabled", value=True)
        try:
            self.tell("Page.reload")
            yield
        finally:
            self.tell("Emulation.setScriptExecutionDisabled", value=False)

    def click(self, selector: str) -> None:
        box = self.value(
            f"(() => {{const e = document.querySelector({json.dumps(selector)}); e.scrollIntoView({{block: 'center'}});"
            "const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]})()"
        )
        for kind in ("mousePressed", "mouseReleased"):
            self.tell("Input.dispatchMouseEvent", type=kind, x=box[0], y=box[1], button="left", clickCount=1)

    def press(self, key: str, code: int, text: str = "") -> None:
        for kind in ("keyDown", "keyUp"):
            self.tell("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code, text=text)
