"""Error messages about files: one printable sentence of limited length."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from regolith_studio.errors import FileError

MAX_NAME_LENGTH = 80
MAX_MESSAGE_LENGTH = 240


def printable(text: str) -> str:
    """`text` in one line, with a question mark for each character that cannot be printed."""
    return "".join(sign if sign.isprintable() else "?" for sign in text)


def lower_first(sentence: str) -> str:
    """A sentence as the end of another one."""
    return sentence[0].lower() + sentence[1:]


def plural(number: int, noun: str) -> str:
    """``1 column``, ``2 columns``."""
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


def display_name(path: Path) -> str:
    """The file's name in printable characters; a long one is shortened in the middle."""
    name = printable(path.name or str(path))
    if len(name) <= MAX_NAME_LENGTH:
        return name
    return f"{name[: MAX_NAME_LENGTH - 25]}…{name[-24:]}"


def message_about(path: Path, predicate: str) -> str:
    """The sentence that begins with the file's name, truncated if it is too long."""
    sentence = f"{display_name(path)} {printable(predicate)}"
    if len(sentence) <= MAX_MESSAGE_LENGTH:
        return sentence
    return f"{sentence[: MAX_MESSAGE_LENGTH - 2]}…."


@contextmanager
def about_file(path: Path) -> Iterator[None]:
    """Put the file's name before what a FileError says of it."""
    try:
        yield
    except FileError as error:
        raise FileError(message_about(path, str(error))) from None


@contextmanager
def any_fault(sentence: str) -> Iterator[None]:
    """Let any error of a library stand for a damaged file: parsers and codecs raise errors of many kinds."""
    try:
        yield
    except (FileError, MemoryError):
        raise
    except Exception:  # noqa: BLE001
        raise FileError(sentence) from None
