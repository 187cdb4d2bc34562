"""The command line: parse, call, print. ``hoop`` is :func:`main`."""

import os
import sys
from collections.abc import Sequence


def main() -> None:
    """Entry point of the command ``hoop``."""
    # read when numpy is imported: on arrays as small as a ring's a second thread costs its core and saves no time
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    # read when numba is imported, for LLVM: compiles in a tenth less time than its 3, to code as fast
    os.environ.setdefault("NUMBA_OPT", "2")
    sys.exit(run())


def run(arguments: Sequence[str] | None = None) -> int:
    """Run one command line and return its exit status; what a user can mend is one sentence on stderr."""
    from . import hoop

    return hoop.run(arguments)


__all__ = ["main", "run"]
