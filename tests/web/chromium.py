"""A headless Chromium that opens one page, driven by the Chrome DevTools Protocol."""

import asyncio
import base64
import itertools
import json
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import aiohttp

PROGRAM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-port=0",
    "--window-size=1600,900",
)


class Chromium:
    """An asynchronous context manager; `errors` holds what the page has logged as errors."""

    async def __aenter__(self) -> Self:
        self.errors: list[str] = []
        self._numbers = itertools.count(1)
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        command = [str(PROGRAM), *FLAGS, f"--user-data-dir={self._profile.name}", "about:blank"]
        self._process = await asyncio.create_subprocess_exec(
            *command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
        )
        port = await asyncio.wait_for(self._debugging_port(), 60)
        self._log = asyncio.create_task(self._process.stderr.read())  # a full pipe would stop it
        self._client = aiohttp.ClientSession()
        async with self._client.get(f"http://127.0.0.1:{port}/json/list") as answer:
            pages = [each for each in await answer.json() if each["type"] == "page"]
        self._socket = await self._client.ws_connect(pages[0]["webSocketDebuggerUrl"], max_msg_size=0)
        for domain in ("Page", "Runtime", "Log", "Network"):
            await self.call(f"{domain}.enable")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._socket.close()
        await self._client.close()
        self._process.terminate()
        await self._process.wait()
        await self._log
        self._profile.cleanup()

    async def _debugging_port(self) -> str:
        while line := (await self._process.stderr.readline()).decode(errors="replace"):
            if found := re.search(r"DevTools listening on ws://[^:]+:(\d+)/", line):
                return found[1]
        raise RuntimeError("Chromium ended before it could be used")

    async def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Result of one command of the protocol."""
        number = next(self._numbers)
        await self._socket.send_json({"id": number, "method": method, "params": parameters})
        while True:
            message = await self._socket.receive_json(timeout=60)
            if message.get("id") == number:
                assert "error" not in message, message
                return message["result"]
            self._note(message)

    def _note(self, message: dict[str, Any]) -> None:
        match message.get("method"), message.get("params"):
            case "Runtime.exceptionThrown", values:
                self.errors.append(json.dumps(values["exceptionDetails"])[:500])
            case "Log.entryAdded", values if values["entry"]["level"] == "error":
                self.errors.append(f"{values['entry']['text']} {values['entry'].get('url', '')}")

    async def open(self, url: str) -> None:
        await self.call("Page.navigate", url=url)

    async def value(self, expression: str) -> Any:
        """What a JavaScript expression is worth."""
        result = await self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    async def wait_for(self, expression: str, seconds: float = 60.0) -> Any:
        """The first value of an expression that is true."""
        async with asyncio.timeout(seconds):
            while not (found := await self.value(expression)):
                await asyncio.sleep(0.1)
        return found

    async def slide(self, element: str, value: float) -> None:
        """Move a slider, as a user does."""
        await self.value(
            f"(e => {{ e.value = {value}; e.dispatchEvent(new Event('input', {{bubbles: true}})) }})"
            f"(document.getElementById('{element}'))"
        )

    async def choose(self, element: str, key: str) -> None:
        """Choose from a list."""
        await self.value(
            f"(e => {{ e.value = '{key}'; e.dispatchEvent(new Event('change', {{bubbles: true}})) }})"
            f"(document.getElementById('{element}'))"
        )

    async def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Drag with the left mouse button, in pixels of the page."""
        (x, y), button = start, {"button": "left", "clickCount": 1}
        await self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        await self.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, buttons=1, **button)
        for share in (0.25, 0.5, 0.75, 1.0):
            x, y = (a + share * (b - a) for a, b in zip(start, end, strict=True))
            await self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, button="left", buttons=1)
            await asyncio.sleep(0.05)
        await self.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, **button)

    async def screenshot(self, path: Path) -> bytes:
        """PNG of the page."""
        answer = await self.call("Page.captureScreenshot", format="png")
        picture = base64.b64decode(answer["data"])
        await asyncio.to_thread(path.write_bytes, picture)
        return picture
