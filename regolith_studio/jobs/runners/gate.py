"""Where a job can be held back, let go on, or stopped: between two of its steps."""

import threading


class Gate:
    """Open at first. Whoever drives a job passes it between two steps; everybody else may close it."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._held = self._stopped = False

    @property
    def held(self) -> bool:
        """Whether the job waits here, or will as soon as it has done the step that it is at."""
        return self._held

    @property
    def stopped(self) -> bool:
        """Whether the job shall go no further."""
        return self._stopped

    def hold(self) -> None:
        """Let the job wait after the step that it is at; harmless when it has been stopped."""
        with self._changed:
            self._held = not self._stopped

    def release(self) -> None:
        """Let it go on."""
        with self._changed:
            self._held = False
            self._changed.notify_all()

    def stop(self) -> None:
        """Let it end, also if it waits."""
        with self._changed:
            self._held, self._stopped = False, True
            self._changed.notify_all()

    def passed(self) -> bool:
        """Wait while the gate is closed; says whether the job may go on."""
        with self._changed:
            self._changed.wait_for(lambda: not self._held)
            return not self._stopped
