"""Every error that a user can cause and mend.

RegolithError
├── InputError            a value or a setting that cannot be used
│   ├── GeometryError     a mesh or half-spaces that enclose no proper volume
│   └── FileError         a file that cannot be read, or is not what it claims to be
├── DatasetError          a dataset folder that is broken, or cannot be written
├── EnvironmentProblem    something that this machine lacks: a display, a program, memory
└── Cancelled             the user stopped the work

The message of each is one plain sentence: what is wrong, with which value, and what would be
right. Wrong use by a programmer stays a ``ValueError`` or ``TypeError``.
"""


class RegolithError(Exception):
    """Base of everything that reaches the user as one sentence."""


class InputError(RegolithError):
    """A value or a setting that cannot be used."""


class GeometryError(InputError):
    """A mesh or a set of half-spaces that encloses no proper volume."""


class FileError(InputError):
    """A file that cannot be read, or is not what it claims to be."""


class DatasetError(RegolithError):
    """A dataset folder that is broken, or cannot be written."""


class EnvironmentProblem(RegolithError):
    """Something that this machine lacks."""


class Cancelled(RegolithError):
    """The user stopped the work."""


def of_the_system(error: OSError) -> str:
    """What the operating system has refused, a full disk say, in a sentence."""
    place = error.filename or "the files"
    return f"The system does not let the program go on with {place} ({error.strerror or error})."
