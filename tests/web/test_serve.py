"""The three views in a real browser, and that nothing is served without the token."""

import asyncio
import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("trame_vtk", reason="The three views in a browser need trame, an extra.")

import numpy as np
from PIL import Image
from trame.app import get_server

from regolith_studio.cli.entry import run
from regolith_studio.readers.particles import sample_particles
from regolith_studio.session.choices import Choices
from regolith_studio.web.server import ViewServer
from tests.web.chromium import PROGRAM, Chromium

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def url() -> Iterator[str]:
    command = [sys.executable, "-m", "regolith_studio", "serve", "--no-browser", "--json"]
    screenless = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, text=True, env=screenless, **pipes) as process:
        assert process.stdout is not None
        lines = [process.stdout.readline() for _ in range(3)]
        yield json.loads("".join(lines))["url"]
        process.terminate()
        _, errors = process.communicate(timeout=60)
    assert process.returncode == 128 + 15
    assert errors.strip() == "Stopped."


def status(address: str) -> int:
    try:
        with urllib.request.urlopen(address, timeout=30) as answer:
            return int(answer.status)
    except urllib.error.HTTPError as error:
        return error.code


def test_that_the_page_and_its_scripts_are_served_below_the_token_only(url: str) -> None:
    root, token = url.rstrip("/").rsplit("/", 1)
    names = ["", "index.html", "vue.global.js", "ws"]
    assert {status(f"{url}{name}") for name in names[:3]} == {200}
    wrong = token[:-1] + ("a" if token[-1] != "a" else "b")
    for below in ("", f"{wrong}/", f"{token.upper()}/", "static/", f"x/../{wrong}/"):
        assert {status(f"{root}/{below}{name}") for name in names} == {404}, below


def test_that_only_this_machine_is_listened_to(url: str) -> None:
    port = int(url.split(":")[2].split("/")[0])
    listeners = Path("/proc/net/tcp").read_text().split("\n")[1:] if Path("/proc/net/tcp").exists() else []
    if not listeners:
        pytest.skip("The sockets of this system are not listed in /proc/net/tcp.")
    local = [line.split()[1] for line in listeners if line and line.split()[3] == "0A"]
    assert [each for each in local if int(each.split(":")[1], 16) == port] == [f"0100007F:{port:04X}"]


async def _use_the_page(url: str, folder: Path) -> dict[str, Any]:
    ready = (
        "document.getElementById('status')?.innerText === 'Done.'"
        " && document.getElementById('assessment').innerText"
        " && document.querySelector('.picture img')?.src.startsWith('blob:')"
        " && document.querySelector('.titles').innerText"
    )
    seen: dict[str, Any] = {}
    async with Chromium() as browser:
        await browser.open(url)
        seen["titles"] = [await browser.wait_for(ready, 240)]
        seen["table"] = await browser.value("document.getElementById('descriptors').innerText")
        for control, value, title in (("l_max", 4, "l_max = 4"), ("n_facets", 12, "12 facets")):
            await browser.slide(control, value)
            await browser.wait_for(f"({ready} || '').includes('{title}')", 240)
        await browser.choose("method", "quadric")
        await browser.wait_for(f"document.getElementById('method').value === 'quadric' && {ready}", 240)
        await asyncio.sleep(3)  # the last picture may still be on its way
        before = await browser.screenshot(folder / "before.png")
        await browser.drag((200, 400), (300, 250))
        for _ in range(60):
            await asyncio.sleep(0.5)
            if await browser.screenshot(folder / "serve.png") != before:
                break
        seen["errors"] = [each for each in browser.errors if "/paraview/" not in each]  # an optional launcher
        await browser.open(url.rstrip("/")[:-1] + "_/")
        seen["refused"] = await browser.wait_for(
            "document.body?.innerText.includes('404') && document.body.innerText", 60
        )
    return seen


def test_that_a_browser_shows_three_views_that_follow_sliders_method_and_mouse(
    url: str, tmp_path: Path
) -> None:
    if PROGRAM is None:
        pytest.skip("There is no Chromium on this machine.")
    seen = asyncio.run(_use_the_page(url, tmp_path))
    assert "agglutinate-1" in seen["titles"][0]
    assert "20 facets (36 vertices, 68 triangles)" in seen["titles"][0]
    assert "AR\t1.92\t1.987\t1.987" in seen["table"]  # exact: the polyhedron has the aspect ratio of the fit
    assert seen["errors"] == []
    assert seen["refused"] == "404: Not Found"
    views = [
        np.asarray(Image.open(tmp_path / name).convert("RGB"), float) for name in ("before.png", "serve.png")
    ]
    third = 400  # pixels; the views are as wide together as the page without the controls
    for column in range(3):
        one, two = (view[60:700, column * third + 20 : (column + 1) * third - 20] for view in views)
        assert np.abs(one - two).mean() > 1.0, "the camera is shared by all views"
        assert two.std() > 10.0, "each view shows a body"


def test_that_an_address_of_another_machine_is_refused_in_a_sentence(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["serve", "sample:all", "--no-browser", "--host", "203.0.113.1"]) == 1
    assert capsys.readouterr().err.startswith("Cannot listen to 203.0.113.1, port 0 (")


def test_that_a_port_in_use_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert run(["serve", "--no-browser", "--port", str(port)]) == 1
    assert capsys.readouterr().err.startswith(f"Cannot listen to 127.0.0.1, port {port} (")


async def _exit_by_a_page() -> int:
    server = ViewServer(sample_particles()[:1], Choices(target="fit", method="quadric"))
    ready = asyncio.Event()
    serving = asyncio.ensure_future(server.run(ready.set))
    await asyncio.wait_for(ready.wait(), 120)
    get_server(server._token).protocol.exit()  # what application.exit of the web socket calls
    await asyncio.sleep(1.0)
    assert not serving.done()
    found = await asyncio.to_thread(status, server.url)
    serving.cancel()
    await asyncio.gather(serving, return_exceptions=True)
    return found


def test_that_a_page_cannot_end_the_server_for_the_others() -> None:
    assert asyncio.run(_exit_by_a_page()) == 200


def test_that_long_headers_leave_no_traceback_and_ctrl_c_ends_in_two_seconds() -> None:
    command = [sys.executable, "-m", "regolith_studio", "serve", "--no-browser", "--json"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, text=True, **pipes) as process:
        assert process.stdout is not None
        address = json.loads("".join(process.stdout.readline() for _ in range(3)))["url"]
        request = urllib.request.Request(address, headers={"X-Long": "x" * 100_000})
        with contextlib.suppress(urllib.error.HTTPError, urllib.error.URLError, ConnectionError):
            urllib.request.urlopen(request, timeout=30)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
    assert errors.strip() == "Stopped."
    assert process.returncode == 130


@pytest.mark.parametrize("seconds", [1.5, 2.0, 3.0, 4.0])
def test_that_ctrl_c_around_the_start_is_one_line(seconds: float) -> None:
    command = [sys.executable, "-m", "regolith_studio", "serve", "--no-browser", "--json"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, text=True, **pipes) as process:
        time.sleep(seconds)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=20)
    assert errors.strip() in ("Stopped.", "")
