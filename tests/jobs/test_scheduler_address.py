"""What is said of an address at which no scheduler answers; the listeners are sockets of this machine."""

import contextlib
import socket
import threading
from collections.abc import Iterator

import pytest

from regolith_studio.errors import InputError, MissingRequirement
from regolith_studio.jobs.runners import dask_cluster
from regolith_studio.jobs.runners.dask_cluster import check_scheduler, parsed_address


@pytest.fixture(autouse=True)
def hasty(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_cluster, "ANSWER_SECONDS", 0.4)


@contextlib.contextmanager
def listener(greeting: bytes) -> Iterator[int]:
    """A port of this machine at which everybody is greeted with some bytes."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        visitors = []

        def serve() -> None:
            with contextlib.suppress(OSError):
                while True:
                    visitor, _ = server.accept()
                    visitors.append(visitor)
                    visitor.sendall(greeting)

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        yield server.getsockname()[1]
        with contextlib.suppress(OSError):
            server.shutdown(socket.SHUT_RDWR)
        thread.join(5)
        for visitor in visitors:
            visitor.close()


@pytest.mark.parametrize(
    ("text", "whole"),
    [
        ("tcp://10.0.0.1:8786", "tcp://10.0.0.1:8786"),
        (" tls://login.example:8786 ", "tls://login.example:8786"),
        ("login:8786", "tcp://login:8786"),
        ("tcp://[::1]:8786", "tcp://[::1]:8786"),
    ],
)
def test_that_an_address_is_read_in_its_usual_forms(text: str, whole: str) -> None:
    assert parsed_address(text) == whole


@pytest.mark.parametrize(
    "text",
    [
        "login",
        "tcp://login",
        "tcp://:8786",
        "  ",
        "tcp://login:0",
        "tcp://login:99999",
        "login:eight",
        "http://login:8787",
        "tcp://[::1:8786",
    ],
)
def test_that_another_form_is_refused_with_the_right_one(text: str) -> None:
    with pytest.raises(InputError, match=r"tcp://HOST:8786 .* from 1 to 65535") as reported:
        parsed_address(text)
    assert repr(text.strip()) in str(reported.value)


def test_that_a_greeting_of_a_few_hundred_bytes_is_taken_for_a_scheduler() -> None:
    with listener((312).to_bytes(8, "little") + b"...") as port:
        check_scheduler(f"tcp://127.0.0.1:{port}")


@pytest.mark.parametrize("greeting", [b"HTTP/1.1 400 Bad Request\r\n\r\n", b"", b"SSH"])
def test_that_another_program_at_the_port_is_told_from_a_scheduler(greeting: bytes) -> None:
    with listener(greeting) as port, pytest.raises(MissingRequirement, match="is no Dask scheduler"):
        check_scheduler(f"tcp://127.0.0.1:{port}")


def test_that_a_closed_port_and_an_unknown_machine_are_told_apart() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    with pytest.raises(MissingRequirement, match="refused"):
        check_scheduler(f"tcp://127.0.0.1:{port}")
    with pytest.raises(MissingRequirement, match=r"no-such-machine.invalid:8786 \((?!.*refused)"):
        check_scheduler("tcp://no-such-machine.invalid:8786")
