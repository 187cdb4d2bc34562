"""The command line: parse, call, print. ``hoop`` is :func:`main`.

``hoop``        all commands, and those of one run    ``study``, ``limit``, ``hop``, ``atlas``  `hoop study`
``bench``       `hoop bench`, `stress`, `validate`    ``view``        pictures of a run
``completion``  what a shell completes                ``shared``      what commands share
"""

import os
import signal
import sys
from collections.abc import Sequence

from ..machine import one_blas_thread, search_garbage_seldom
from .shared.letters import spell_out


def main() -> None:
    """Entry point of the command ``hoop``."""
    # what a batch system ends a job with stops it as Ctrl-C does: what there is is kept, and said
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    spell_out()
    one_blas_thread()
    search_garbage_seldom()
    # read when numba is imported, for LLVM: compiles in a tenth less time than its 3, to code as fast
    os.environ.setdefault("NUMBA_OPT", "2")
    # figures are files: no window's backend is needed, whatever the environment names, perhaps one of years ago
    os.environ["MPLBACKEND"] = "agg"
    sys.exit(run())


def run(arguments: Sequence[str] | None = None) -> int:
    """Run one command line and return its exit status; what a user can mend is one sentence on stderr."""
    try:
        from . import hoop
    except KeyboardInterrupt:
        print("hoop: Interrupted.", file=sys.stderr)
        return 130
    return hoop.run(arguments)


__all__ = ["main", "run"]
