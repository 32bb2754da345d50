"""The Fortran behind the transforms, from many threads and at start."""

import subprocess
import sys
from textwrap import dedent


def _python(program: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(  # its own process: what these look for kills the one that it happens in
        [sys.executable, "-c", dedent(program)], capture_output=True, text=True, timeout=120, check=False
    )


def test_that_four_threads_get_what_one_gets_and_nothing_crashes():
    done = _python("""
        from concurrent.futures import ThreadPoolExecutor
        import numpy as np
        from regolith_studio.harmonics.coefficients import ShCoefficients
        from regolith_studio.harmonics.transform import evaluate_on_grid, expand, ray_grid

        kept = ShCoefficients(np.random.default_rng(0).normal(size=21**2))
        grids = [ray_grid(degree, kind) for kind in ("glq", "dh2") for degree in (20, 24, 31)]
        def there_and_back(grid):
            return expand(grid, evaluate_on_grid(grid, kept), 20).values
        wanted = [there_and_back(grid) for grid in grids]
        with ThreadPoolExecutor(4) as pool:
            found = list(pool.map(there_and_back, grids * 100))
        for k, values in enumerate(found):
            np.testing.assert_array_equal(values, wanted[k % len(grids)])
        """)
    assert done.returncode == 0, done.stderr[:2000]


def test_that_importing_the_fit_does_not_load_pyshtools():
    done = _python("""
        import sys
        import regolith_studio.harmonics.fit
        assert "pyshtools" not in sys.modules
        """)
    assert done.returncode == 0, done.stderr[:2000]
