"""The command line: parse, call, print. ``hoop`` is :func:`main`."""

from .hoop import main, run

__all__ = ["main", "run"]
