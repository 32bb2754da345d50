"""Whether a Dask scheduler answers at an address, and if not, why, within seconds.

Dask's own client tries for half a minute, and takes what a web server answers for the length of a message.
"""

import socket
import time
from dataclasses import dataclass
from typing import Self
from urllib.parse import urlsplit

from regolith_studio.errors import EnvironmentProblem, InputError

PATIENCE = 4.0
"""Seconds in which a scheduler must answer."""
SCHEMES = ("tcp", "tls")
LONGEST_GREETING = 1 << 16
"""Bytes; a scheduler begins with the length of a message of some hundred."""
_FORM = "it has the form tcp://HOST:8786 or tls://HOST:8786"


@dataclass(frozen=True)
class SchedulerAddress:
    """Where a scheduler listens."""

    scheme: str
    host: str
    port: int

    @classmethod
    def parsed(cls, text: str) -> Self:
        """From ``tcp://host:port``, ``tls://host:port`` or ``host:port``.

        Raises
        ------
        InputError
            Saying what is wrong.
        """
        given = text.strip()
        parts = urlsplit(given if "://" in given else f"tcp://{given}")
        if parts.scheme not in SCHEMES:
            raise InputError(f"The address {given} begins with {parts.scheme}://; {_FORM}.")
        try:
            port = parts.port
        except ValueError:
            raise InputError(
                f"The address {given} has a port that is no number up to 65535; {_FORM}."
            ) from None
        if not parts.hostname or port is None:
            missing = "host" if not parts.hostname else "port"
            raise InputError(f"The address {given or 'that was given'} has no {missing}; {_FORM}.")
        return cls(parts.scheme, parts.hostname, port)

    def __str__(self) -> str:
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{self.scheme}://{host}:{self.port}"

    def check(self) -> None:
        """Knock.

        Raises
        ------
        EnvironmentProblem
            If nobody answers, or somebody else.
        """
        deadline = time.monotonic() + PATIENCE
        with self._connected(deadline) as door:
            if self.scheme == "tcp":
                door.settimeout(max(0.1, deadline - time.monotonic()))
                self._listen(door)

    def _connected(self, deadline: float) -> socket.socket:
        while True:
            try:
                return socket.create_connection((self.host, self.port), max(0.1, deadline - time.monotonic()))
            except socket.gaierror as error:
                raise EnvironmentProblem(
                    f"No cluster answers at {self}: there is no machine called {self.host}."
                ) from error
            except ConnectionRefusedError as error:  # it may be about to start
                if time.monotonic() + 0.2 > deadline:
                    raise EnvironmentProblem(
                        f"No cluster answers at {self}: the machine is there, but nothing listens on port "
                        f"{self.port}."
                    ) from error
                time.sleep(0.2)
            except OSError as error:
                raise EnvironmentProblem(
                    f"No cluster answers at {self} ({error.strerror or error})."
                ) from error

    def _listen(self, door: socket.socket) -> None:
        """A scheduler speaks first: eight bytes of length, little-endian."""
        try:
            greeting = door.recv(8, socket.MSG_WAITALL) if hasattr(socket, "MSG_WAITALL") else door.recv(8)
        except OSError:
            greeting = b""
        if len(greeting) < 8 or not 0 < int.from_bytes(greeting, "little") < LONGEST_GREETING:
            raise EnvironmentProblem(
                f"What answers at {self} is no Dask scheduler; take the scheduler's port (usually 8786), "
                "not of its dashboard (8787) or of a worker, and tls:// where it is encrypted."
            )
