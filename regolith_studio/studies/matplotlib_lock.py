"""A lock for drawing with matplotlib, which is not thread-safe.

Its threads share fonts, whose glyphs are loaded into the same memory: two that draw at once mix their letters
or crash the process. Hold :data:`MATPLOTLIB_LOCK` while writing a figure or rendering a formula.
"""

from threading import RLock

MATPLOTLIB_LOCK = RLock()
