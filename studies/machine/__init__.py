"""What a study takes of the machine it runs on: ``processes`` that work side by side,
``kernels`` compiled for it, and the ``build`` of versions and sources that results hang on."""

import gc
import os

OBJECTS = 50_000
BLAS_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def one_blas_thread() -> None:
    """From the import of numpy on, unless the environment says otherwise.

    On arrays as small as a ring's a second thread costs its core and saves no time; where several processes have two
    each, they wait for one another.
    """
    for name in BLAS_THREADS:
        os.environ.setdefault(name, "1")


def search_garbage_seldom() -> None:
    """Look for what is in circles of references after 50 000 new objects.

    Python does after 700, or 2000 from 3.13 on. Next to nothing that a study makes is in one, and what it imports and
    draws stays: looking after every 700 took a twentieth of its time.
    """
    if 0 < gc.get_threshold()[0] < OBJECTS:  # 0 is a user's own: never
        gc.set_threshold(OBJECTS, 20, 50)
