"""What a study takes of the machine it runs on: ``processes`` that work side by side, ``kernels`` compiled for it."""

import os

BLAS_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def one_blas_thread() -> None:
    """From the import of numpy on, unless the environment says otherwise.

    On arrays as small as a ring's a second thread costs its core and saves no time; where several processes have two
    each, they wait for one another.
    """
    for name in BLAS_THREADS:
        os.environ.setdefault(name, "1")
