"""Functions that fill any pyvista plotter: the window, the headless figures and the tests use them alike."""
