"""Models of shape: seconds of one core for a fit and for 100,000 particles.

    python benchmarks/model.py [PARTICLES]

The sample is drawn from a shipped material card. Set OPENBLAS_NUM_THREADS=1 for numbers that compare.
"""

import sys
import time

import numpy as np

from regolith_studio.shape_models.materials import materials
from regolith_studio.shape_models.models import MODELS
from regolith_studio.shape_models.sample import Sample

L_MAX = 20
N_DRAWS = 10_000


def main(n: int) -> None:
    """Print one line a model."""
    draws = materials()["ma165"].model(L_MAX).draw(n, 0)
    sample = Sample(np.stack([draws.particle(i).values for i in range(n)]))
    print(f"{n} particles at l_max {L_MAX}; draws at l_max 10; seconds of one core")
    for key, model in MODELS.items():
        begin = time.process_time()
        fitted = model.fit(sample)
        middle = time.process_time()
        fitted.draw(10, 0)
        first = time.process_time()
        fitted.draw(N_DRAWS, 0)
        per_draw = (time.process_time() - first) / N_DRAWS
        print(f"{key:16} fit {middle - begin:6.2f}   first draw {first - middle:6.2f}", end="   ")
        print(f"100,000 draws {1e5 * per_draw:6.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3338)
