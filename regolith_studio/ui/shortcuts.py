"""User-defined shortcuts: the keys of each command, conflicts, and their storage in the preferences."""

from collections.abc import Mapping

from PySide6.QtGui import QAction, QKeySequence

from regolith_studio.errors import InputError
from regolith_studio.session.preferences import Preferences
from regolith_studio.ui.translation import tr

SHORTCUTS = "shortcuts"
"""In the preferences of the window: keys by the name of the command, where they are not the usual ones."""
_NEEDED = {
    "Tab",
    "Shift+Tab",
    "Return",
    "Enter",
    "Esc",
    "Space",
    "Backspace",
    "Del",
    "Up",
    "Down",
    "Left",
    "Right",
}


class Shortcuts:
    """The shortcuts of all commands; commands that are shown together must not share keys.

    Parameters
    ----------
    actions
        By name; those of a page begin with its key and a dot, and work while the page is seen.
    pages
        Keys of the pages.
    """

    def __init__(
        self, actions: Mapping[str, QAction], pages: tuple[str, ...], preferences: Preferences
    ) -> None:
        self.actions = {name: each for name, each in actions.items() if each.menu() is None and each.text()}
        self._pages, self._preferences = pages, preferences
        self.defaults = {name: each.shortcut().toString() for name, each in self.actions.items()}
        kept = preferences.window.get(SHORTCUTS)
        for name, keys in kept.items() if isinstance(kept, dict) else ():
            if name in self.actions and isinstance(keys, str) and not self.conflict(name, keys):
                self._set(name, keys)

    def keys(self, name: str) -> str:
        """Of one command, as ``Ctrl+Shift+P``; empty for none."""
        return self.actions[name].shortcut().toString()

    def conflict(self, name: str, keys: str) -> str:
        """One sentence on why a command cannot have these keys, or nothing."""
        sequence = QKeySequence(keys)
        text = sequence.toString()
        if not keys:
            return ""
        if not text or sequence.count() != 1:
            return tr("{keys} cannot be assigned to a command.", keys=keys)
        if text in _NEEDED or (len(text) == 1 and text.isprintable()):
            return tr("{keys} is reserved for typing and navigation; add Ctrl or Alt.", keys=text)
        for other in self.actions:
            if other != name and self.keys(other) == text and self._meet(name, other):
                name_of_other = plain(self.actions[other])
                return tr("{keys} is already assigned to “{command}”.", keys=text, command=name_of_other)
        return ""

    def change(self, name: str, keys: str) -> None:
        """Give a command other keys, and keep them.

        Raises
        ------
        InputError
            If another command has them, or they are needed otherwise.
        """
        if sentence := self.conflict(name, keys):
            raise InputError(sentence)
        self._set(name, keys)
        self._keep()

    def reset(self) -> None:
        """Give every command its usual keys."""
        for name, keys in self.defaults.items():
            self._set(name, keys)
        self._keep()

    def _set(self, name: str, keys: str) -> None:
        action = self.actions[name]
        tip = action.toolTip().removesuffix(with_keys("", action.shortcut()))
        action.setShortcut(QKeySequence(keys))
        action.setToolTip(with_keys(tip, action.shortcut()))

    def _keep(self) -> None:
        changed = {
            name: self.keys(name) for name, default in self.defaults.items() if self.keys(name) != default
        }
        self._preferences.window = self._preferences.window | {SHORTCUTS: changed}
        self._preferences.save()

    def _meet(self, one: str, other: str) -> bool:
        """Whether both can be run on the same page."""
        owners = [name.split(".")[0] if name.split(".")[0] in self._pages else "" for name in (one, other)]
        return "" in owners or owners[0] == owners[1]


def shown_keys(keys: QKeySequence) -> str:
    """Keys as the keyboard of the user names them."""
    return keys.toString(QKeySequence.SequenceFormat.NativeText)


def with_keys(words: str, keys: QKeySequence) -> str:
    """A tool tip that ends with the keys, if there are any."""
    return words if keys.isEmpty() else f"{words} ({shown_keys(keys)})"


def plain(action: QAction) -> str:
    """The words of a command, without marks and dots."""
    return action.text().replace("&", "").rstrip(" …")
