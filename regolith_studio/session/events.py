"""The events of a session, as psygnal signals; all are emitted in the thread that owns the session."""

from dataclasses import dataclass

from psygnal import Signal


@dataclass(frozen=True)
class Failure:
    """Work that could not be done: what it was, one sentence, and the details of a report."""

    title: str
    sentence: str
    details: str = ""


class SessionEvents:
    """What can be listened to; events without an argument mean "read the session anew".

    Connected functions are called with as many of the arguments as they take. Bound methods are held weakly,
    other functions until they are disconnected.
    """

    particles = Signal()
    choices = Signal(frozenset)
    """Names of the fields of the choices that have another value now."""
    fit = Signal()
    surface = Signal()
    descriptors = Signal()
    coarsening = Signal()
    lmax_study = Signal()
    coarsening_study = Signal()
    tasks = Signal()
    dataset_folder = Signal()
    opened_request = Signal()
    failed = Signal(Failure)
    problems = Signal(tuple)
    """Files that were refused at opening, or particles that an export left out, as ``Problem``."""
    exported = Signal(object)
    """Path of the folder that was written."""
