"""Icons for the health of a mesh, one for each word that tells it."""

from PySide6.QtGui import QPixmap

from regolith_studio.ui.icons import pixmap
from regolith_studio.ui.theme import Theme

HEALTH_ICONS = {
    "sound": "sound",
    "coarse": "doubtful",
    "mended": "doubtful",
    "doubtful": "doubtful",
    "unsound": "unsound",
    "unknown": "unknown",
}
"""Name of the icon for each word of :func:`regolith_studio.session.sample_table.health_word`."""
SIZE = 15


def health_pixmaps(theme: Theme) -> dict[str, QPixmap]:
    """The icons in the colours of a theme, by word."""
    colours = {
        "sound": theme.good,
        "doubtful": theme.doubtful,
        "unsound": theme.bad,
        "unknown": theme.muted,
    }
    return {word: pixmap(name, colours[name], SIZE) for word, name in HEALTH_ICONS.items()}
