"""Errors that a user can cause and repair; each message is one plain sentence.

RegolithError
├── InputError            a value or a setting that cannot be used
│   ├── GeometryError     a mesh or half-spaces that enclose no proper volume
│   └── FileError         a file that cannot be read, or is not what it claims to be
├── DatasetError          a dataset folder that is broken, or cannot be written
├── MissingRequirement    something that this machine lacks: a display, a program, memory
└── JobCancelled          the user stopped the work

A message says what is wrong, with which value, and what was expected. Wrong use by a programmer stays a
``ValueError`` or ``TypeError``.
"""

import errno
import json
import re
import sys
from collections.abc import Mapping, Sequence
from typing import Any


class RegolithError(Exception):
    """Base of everything that reaches the user as one sentence."""

    def __str__(self) -> str:
        """The sentence; where it was made as one, a ``Message``, which the window translates."""
        first = self.args[0] if self.args else ""
        return first if isinstance(first, str) else str(first)


class InputError(RegolithError):
    """A value or a setting that cannot be used."""


class GeometryError(InputError):
    """A mesh or a set of half-spaces that encloses no proper volume."""


class FileError(InputError):
    """A file that cannot be read, or is not what it claims to be."""


class DatasetError(RegolithError):
    """A dataset folder that is broken, or cannot be written."""


class MissingRequirement(RegolithError):
    """Something that this machine lacks."""


class JobCancelled(RegolithError):
    """The user stopped the work."""


stop_requests: list[int] = []
"""Numbers of the signals that have asked this process to end."""


def check_not_stopped() -> None:
    """Raise a signal's interruption again before a result is kept.

    A library may have swallowed it, or made an ordinary error of it, which then looks like a fault of one
    particle (matplotlib's ValueError, a callback of Qhull). What tidies up after an interruption may write.

    Raises KeyboardInterrupt if a signal has asked this process to end.
    """
    if stop_requests and not isinstance(sys.exc_info()[1], KeyboardInterrupt | GeneratorExit):
        raise KeyboardInterrupt


def format_os_error(error: OSError) -> str:
    """What the operating system has refused, a full disk say, in a sentence."""
    place = error.filename or "the files"
    return f"Cannot access {place}: {os_error_reason(error)}."


_REASONS = {
    errno.ENOENT: "there is no such file",
    errno.EACCES: "you are not allowed to",
    errno.EPERM: "you are not allowed to",
    errno.EEXIST: "there is a file of that name",
    errno.EISDIR: "it is a folder",
    errno.ENOTDIR: "a part of its path is no folder",
    errno.ENAMETOOLONG: "its name is too long",
    errno.ELOOP: "its links go round in circles",
    errno.EIO: "the disk fails",
    errno.ENOSPC: "the disk is full",
    errno.EROFS: "the file system is read-only",
    errno.EMFILE: "too many files are open",
}


def os_error_reason(error: OSError) -> str:
    """Why the operating system refuses a file, in words; its own where there are none here."""
    return _REASONS.get(error.errno or 0, error.strerror or str(error))


VALIDATION_MESSAGES = {
    "missing": "is missing",
    "extra_forbidden": "is not known here",
    "string_type": "must be text",
    "int_type": "must be a whole number",
    "int_parsing": "must be a whole number",
    "int_parsing_size": "must be a smaller whole number",
    "int_from_float": "must be a whole number",
    "float_type": "must be a number",
    "float_parsing": "must be a number",
    "finite_number": "must be a finite number",
    "bool_type": "must be true or false",
    "bool_parsing": "must be true or false",
    "list_type": "must be a list in [ ]",
    "tuple_type": "must be a list in [ ]",
    "dict_type": "must be named values in {{ }}",
    "model_type": "must be named values in {{ }}",
    "model_attributes_type": "must be named values in {{ }}",
    "none_required": "must be left out or null",
    "literal_error": "must be {expected}",
    "enum": "must be {expected}",
    "greater_than": "must be more than {gt:g}",
    "greater_than_equal": "must be at least {ge:g}",
    "less_than": "must be less than {lt:g}",
    "less_than_equal": "must be at most {le:g}",
    "too_short": "is too short: it has {actual_length} of at least {min_length} entries",
    "too_long": "is too long: it has {actual_length} entries, and at most {max_length} are allowed",
    "string_too_short": "must have {min_length} letters or more",
    "string_too_long": "must have {max_length} letters or fewer",
    "string_pattern_mismatch": "has letters or a form that are not allowed there",
    "union_tag_invalid": "must have a {discriminator} that is one of {expected_tags}",
    "union_tag_not_found": "has no {discriminator}",
    "value_error": "{error}",
}
"""Plain words for pydantic's kinds of error, by their names."""

_SHOW_NO_VALUE = ("missing", "extra_forbidden", "too_short", "too_long", "union_tag_not_found", "value_error")
_KIND_OF_A_UNION = re.compile(r"(str|int|float|bool|list|dict|tuple|none)$|.*[\[(]|[A-Z]")
_LONGEST_VALUE = 40


def format_validation_error(problems: Sequence[Mapping[str, Any]]) -> str:
    """Words for the entry of a document that pydantic refuses: where it stands, and what it must be.

    ``problems``: what its ``ValidationError.errors()`` returns. Where an entry may be of several kinds, the
    kind whose inner entries are complained of is taken for the one that was meant.
    """
    first = problems[0]
    near = [each for each in problems if each["loc"][:2] == first["loc"][:2]]
    problem = max(near, key=lambda each: len(each["loc"]))
    kind, given = str(problem["type"]), problem.get("ctx", {})
    if kind == "json_invalid":
        return _where_json_ends(str(given.get("error", "")))
    place = _place(problem["loc"])
    words = VALIDATION_MESSAGES[kind].format(**given) if kind in VALIDATION_MESSAGES else "cannot be used"
    if kind == "value_error":
        return words if not place else f"{place}: {words[:1].lower()}{words[1:]}"
    value = "" if kind in _SHOW_NO_VALUE else f", not {_shown(problem.get('input'))}"
    return f"{place or 'the whole of it'} {words}{value}"


def _where_json_ends(said: str) -> str:
    """Where a parser stopped; `said` ends in ``at line 3 column 5``."""
    found = re.search(r"line (\d+) column (\d+)", said)
    if found is None or found.groups() in (("1", "0"), ("0", "0")):
        return "it is empty, or no JSON"
    return f"it is no proper JSON from line {found[1]}, column {found[2]} on"


def _place(parts: Sequence[str | int]) -> str:
    """``inputs[0].unit``; which kind of a union was tried is left out."""
    place = ""
    for number, part in enumerate(parts):
        if isinstance(part, int):
            place += f"[{part}]"
        elif number == 0 or not _KIND_OF_A_UNION.match(part):
            place += f".{_short(part)}" if place else _short(part)
    return place


def _shown(value: Any) -> str:
    """The beginning of a value, however long it is."""
    text = ""
    for part in json.JSONEncoder(ensure_ascii=False, default=str).iterencode(value):
        text += part[: _LONGEST_VALUE + 1]
        if len(text) > _LONGEST_VALUE:
            break
    return _short(text)


def _short(text: str) -> str:
    """In one line, with a question mark for each sign that cannot be shown, cut where it is long."""
    text = "".join(sign if sign.isprintable() else "?" for sign in text[: _LONGEST_VALUE + 1])
    return text if len(text) <= _LONGEST_VALUE else f"{text[: _LONGEST_VALUE - 1]}…"
