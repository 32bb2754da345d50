"""What a file says about itself, made fit for a sentence: printable and short."""

from pathlib import Path

LONGEST_NAME = 80
LONGEST_SENTENCE = 240


def printable(text: str) -> str:
    """`text` in one line, with a question mark for each sign that cannot be shown."""
    return "".join(sign if sign.isprintable() else "?" for sign in text)


def counted(number: int, thing: str) -> str:
    """``1 column``, ``2 columns``."""
    return f"{number:,} {thing}{'' if number == 1 else 's'}"


def shown_name(path: Path) -> str:
    """The file's name, without its middle where it is long."""
    name = printable(path.name or str(path))
    if len(name) <= LONGEST_NAME:
        return name
    return f"{name[: LONGEST_NAME - 25]}…{name[-24:]}"


def sentence_about(path: Path, predicate: str) -> str:
    """The sentence that begins with the file's name; one that grows too long loses its end."""
    sentence = f"{shown_name(path)} {printable(predicate)}"
    if len(sentence) <= LONGEST_SENTENCE:
        return sentence
    return f"{sentence[: LONGEST_SENTENCE - 2]}…."
