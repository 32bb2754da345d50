"""Matplotlib draws for one thread at a time.

Threads share its fonts, whose glyphs are loaded into the same memory: two that draw at once get each other's
letters, or end the process. Who writes a figure or sets a formula holds :data:`DRAWING` meanwhile.
"""

from threading import RLock

DRAWING = RLock()
