"""A headless Chromium over its debugging pipe: open a page, run scripts in it, take pictures."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import base64
import contextlib
import json
import os
import select
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from types import TracebackType
from typing import Any

#: Names under which Chromium is installed.
NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")


def find_browser() -> str | None:
    """Path of a Chromium, or None."""
    return next((path for name in NAMES if (path := shutil.which(name))), None)


class BrowserError(RuntimeError):
    """The browser does not answer."""


class ScriptError(BrowserError):
    """A script in the page failed."""


class Browser:
    """One page of a headless browser.

    Parameters
    ----------
    width, height : int
        Size of the page [pixels].
    dark : bool
        Prefer the dark theme.

    Attributes
    ----------
    console : list of str
        Errors and warnings of the console, and uncaught exceptions.
    requests : list of str
        Addresses that the page requested, data and blobs left out.
    """

    def __init__(self, width: int = 1400, height: int = 1000, dark: bool = False) -> None:
        found = find_browser()
        if found is None:
            raise BrowserError("there is no Chromium")
        self.console: list[str] = []
        self.requests: list[str] = []
        self._folder = tempfile.mkdtemp(prefix="corota-browser-")
        to_read, self._to = os.pipe()
        self._from, to_write = os.pipe()

        def wire() -> None:
            # The browser reads commands from 3 and writes answers to 4.
            high = [os.dup(to_read), os.dup(to_write)]
            while min(high) < 5:
                high = [os.dup(end) for end in high]
            os.dup2(high[0], 3)
            os.dup2(high[1], 4)

        options = [
            "--headless=new", "--no-sandbox", "--disable-gpu-sandbox", "--mute-audio",
            "--no-first-run", "--disable-extensions", "--disable-background-networking",
            "--disable-component-update", "--hide-scrollbars", "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader", "--disable-gpu-watchdog", "--remote-debugging-pipe",
            f"--user-data-dir={self._folder}", f"--window-size={width},{height}", "about:blank",
        ]  # fmt: skip
        self._process = subprocess.Popen(
            [found, *options],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            close_fds=False,
            preexec_fn=wire,
        )
        os.close(to_read)
        os.close(to_write)
        self._number, self._rest = 0, b""
        self._session = ""
        pages = self.send("Target.getTargets")["targetInfos"]
        target = next(p["targetId"] for p in pages if p["type"] == "page")
        attached = self.send("Target.attachToTarget", targetId=target, flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.send(f"{domain}.enable")
        self.resize(width, height)
        self.prefer("dark" if dark else "light")

    def send(self, method: str, **params: Any) -> dict[str, Any]:
        """Send a command; its answer."""
        self._number += 1
        message: dict[str, Any] = {"id": self._number, "method": method, "params": params}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        limit = time.monotonic() + 120.0
        while True:
            found = self._read(limit)
            if found.get("id") == self._number:
                if "error" in found:
                    raise BrowserError(f"{method}: {found['error']['message']}")
                answer: dict[str, Any] = found["result"]
                return answer
            self._note(found)

    def _read(self, limit: float) -> dict[str, Any]:
        while b"\0" not in self._rest:
            if not select.select([self._from], [], [], max(0.0, limit - time.monotonic()))[0]:
                raise BrowserError("the browser does not answer")
            data = os.read(self._from, 1 << 16)
            if not data:
                raise BrowserError("the browser has ended")
            self._rest += data
        line, _, self._rest = self._rest.partition(b"\0")
        message: dict[str, Any] = json.loads(line)
        return message

    def _note(self, event: dict[str, Any]) -> None:
        kind, params = event.get("method"), event.get("params", {})
        if kind == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.console.append(details.get("exception", {}).get("description", details["text"]))
        elif kind == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning"):
            self.console.append(" ".join(str(a.get("value", a)) for a in params["args"]))
        elif kind == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.console.append(params["entry"]["text"])
        elif kind == "Network.requestWillBeSent":
            address = params["request"]["url"]
            if not address.startswith(("data:", "blob:")):
                self.requests.append(address)

    def resize(self, width: int, height: int) -> None:
        """Give the page a size [pixels]."""
        self.send(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

    def prefer(self, scheme: str) -> None:
        """Prefer a color scheme, ``light`` or ``dark``."""
        feature = {"name": "prefers-color-scheme", "value": scheme}
        self.send("Emulation.setEmulatedMedia", features=[feature])

    def open(self, address: str, ready: str = "true", timeout: float = 60.0) -> None:
        """Open an address and wait until an expression holds."""
        self.console.clear()
        self.requests.clear()
        self.send("Page.navigate", url=address)
        self.wait(ready, timeout)

    def run(self, expression: str) -> Any:
        """Value of an expression in the page; promises are awaited."""
        found = self.send(
            "Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True
        )
        if "exceptionDetails" in found:
            details = found["exceptionDetails"]
            text = details.get("exception", {}).get("description", details["text"])
            raise ScriptError(f"{expression}: {text}")
        return found["result"].get("value")

    def wait(self, expression: str, timeout: float = 20.0) -> None:
        """Wait until an expression holds."""
        limit = time.monotonic() + timeout
        while not self._holds(expression):
            if time.monotonic() > limit:
                raise BrowserError(f"not within {timeout:g} s: {expression}; {self.console}")
            time.sleep(0.05)

    def _holds(self, expression: str) -> bool:
        try:
            return bool(self.run(f"Boolean({expression})"))
        except ScriptError:  # the page is not there yet
            return False

    def click(self, x: float, y: float) -> None:
        """Click a place of the page [pixels]."""
        for kind in ("mousePressed", "mouseReleased"):
            self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def key(self, name: str, code: int = 0) -> None:
        """Press a key by its name, such as ``ArrowRight``."""
        text = {"text": name} if len(name) == 1 else {}
        common = {"key": name, "windowsVirtualKeyCode": code}
        self.send("Input.dispatchKeyEvent", type="keyDown", **common, **text)
        self.send("Input.dispatchKeyEvent", type="keyUp", **common)

    def picture(self, path: Path, whole: bool = False) -> None:
        """Write what the page shows, or all of it, as PNG."""
        found = self.send("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        path.write_bytes(base64.b64decode(found["data"]))

    def close(self) -> None:
        """End the browser."""
        with contextlib.suppress(BrowserError, OSError):
            self._session = ""
            self.send("Browser.close")
        for end in (self._to, self._from):
            with contextlib.suppress(OSError):
                os.close(end)
        try:
            self._process.wait(10.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)

    def __enter__(self) -> Browser:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
