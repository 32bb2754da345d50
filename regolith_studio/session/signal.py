"""A list of callbacks; all that the session needs to be watched."""

from collections.abc import Callable
from typing import Generic, ParamSpec

P = ParamSpec("P")


class Signal(Generic[P]):
    """Calls what is connected to it, in order, in the thread that emits.

    Callbacks are held strongly: who connects disconnects, with the function that
    :meth:`connect` returns or by :meth:`disconnect`.
    """

    def __init__(self) -> None:
        self._callbacks: list[Callable[P, object]] = []

    def connect(self, callback: Callable[P, object]) -> Callable[[], None]:
        """Call `callback` at every emission, until the returned function is called."""
        self._callbacks.append(callback)
        return lambda: self.disconnect(callback)

    def disconnect(self, callback: Callable[P, object]) -> None:
        """Forget `callback`; harmless when it is not connected."""
        if callback in self._callbacks:
            self._callbacks.remove(callback)

    def emit(self, *args: P.args, **kwargs: P.kwargs) -> None:
        """Call every callback; one that is disconnected meanwhile is not called any more."""
        for callback in tuple(self._callbacks):
            if callback in self._callbacks:
                callback(*args, **kwargs)

    def __len__(self) -> int:
        return len(self._callbacks)
