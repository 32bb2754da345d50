"""An axis that counts: no tick lies between two steps, degrees or facets."""

import pyqtgraph as pg


class CountAxis(pg.AxisItem):  # type: ignore[misc]
    """An axis whose ticks lie at whole numbers while :attr:`whole` is set, and anywhere otherwise."""

    whole = False

    def tickSpacing(self, low: float, high: float, length: float) -> list[tuple[float, float]]:
        """Spacings and offsets of major and minor ticks, none below one where only whole numbers exist."""
        levels: list[tuple[float, float]] = super().tickSpacing(low, high, length)
        if not (self.whole and levels):
            return levels
        return [level for level in levels if level[0] >= 1.0] or [(1.0, 0.0)]
