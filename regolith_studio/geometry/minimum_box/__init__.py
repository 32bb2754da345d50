"""The minimum-volume box of a convex solid: a search whose result is proven (O'Rourke 1985)."""
