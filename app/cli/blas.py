"""How many threads the linear algebra below NumPy may use."""

import os


def use_one_thread() -> None:
    """Keep BLAS to one thread; call it before NumPy is imported.

    The matrices are small, and a second thread on a busy core can make a solver step fifty times
    slower. With one thread, results repeat bit for bit.
    """
    for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
