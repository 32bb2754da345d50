"""From grey values to labels: a pixel step and an object step (section 2.1)."""
