"""Each file of tests runs in a process of its own, forked from the one that collected them all.

Compiled kernels, VTK and Mesa's compiler stay in a process until it ends: together they take more than a gigabyte, the
dearest file alone less than half of one. It also keeps files from seeing what others left in caches. The fork begins
with all modules imported, so it costs a second at most: to load the kernels that the file needs. Where there is no safe
fork, and under a debugger, everything runs in one process.
"""

from __future__ import annotations

import gc
import os
import sys
import warnings
from itertools import takewhile
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import Any

import pytest

#: what a child tells: a hook of pytest by name and its arguments, a report as plain data; or that an item is done
Told = tuple[str, dict[str, Any]]
DONE: Told = ("done", {})


class Teller:
    """In the child, in place of the terminal: passes on what pytest has to say of its tests."""

    def __init__(self, config: pytest.Config, end: Connection) -> None:
        self.config, self.end = config, end
        self.told_before = True  # of earlier files: pytest repeats it to every plugin that joins

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        data = self.config.hook.pytest_report_to_serializable(config=self.config, report=report)
        self.end.send(("report", data))

    def pytest_warning_recorded(
        self, warning_message: warnings.WarningMessage, when: str, nodeid: str, location: tuple[str, int, str] | None
    ) -> None:
        if self.told_before:
            return
        warning_message.source = None  # the object that warned: it need not survive the journey
        told = {"warning_message": warning_message, "when": when, "nodeid": nodeid, "location": location}
        self.end.send(("warning", told))


class Apart:
    """In the parent: the child of the file that is being run, and the end of the pipe to it."""

    def __init__(self) -> None:
        self.child = 0
        self.end: Connection | None = None

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item, nextitem: pytest.Item | None) -> bool:
        if self.end is None:
            self._fork(item)
        hook = item.ihook
        hook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
        for what, told in iter(self._hear, DONE):
            if what == "report":
                hook.pytest_runtest_logreport(
                    report=hook.pytest_report_from_serializable(config=item.config, data=told)
                )
            elif what == "warning":
                hook.pytest_warning_recorded.call_historic(kwargs=told)
            else:
                died = f"the process of this file ended: status {os.waitpid(self.child, 0)[1]}"
                hook.pytest_runtest_logreport(
                    report=pytest.TestReport(item.nodeid, item.location, {}, "failed", died, "call")
                )
                self.end = None  # the file's other tests get another
                break
        hook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
        if self.end is not None and (nextitem is None or nextitem.path != item.path):
            self._let_go()
        return True

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self) -> None:
        if self.end is not None:  # stopped at a failure, or by hand
            self._let_go()

    def _hear(self) -> Told:
        assert self.end is not None
        try:
            told: Told = self.end.recv()
        except (EOFError, ConnectionError):
            return "died", {}
        return told

    def _let_go(self) -> None:
        assert self.end is not None
        self.end.close()
        self.end = None
        os.waitpid(self.child, 0)

    def _fork(self, first: pytest.Item) -> None:
        start = first.session.items.index(first)
        items = list(takewhile(lambda item: item.path == first.path, first.session.items[start:]))
        self.end, childs = Pipe()
        with warnings.catch_warnings():  # OpenBLAS has threads, and its own provision for a fork
            warnings.simplefilter("ignore", DeprecationWarning)
            self.child = os.fork()
        if self.child:
            childs.close()
            return
        status = 1
        try:
            self.end.close()
            _run(items, childs, self)
            status = 0
        finally:
            os._exit(status)


def _run(items: list[pytest.Item], end: Connection, parents: Apart) -> None:
    """In the child: the tests of one file as pytest runs them."""
    gc.freeze()  # what the parent has stays: looked at by the collector it would be copied
    config = items[0].config
    config.pluginmanager.unregister(parents)
    config.pluginmanager.unregister(name="terminalreporter")
    teller = Teller(config, end)
    config.pluginmanager.register(teller)
    teller.told_before = False
    for item, following in zip(items, [*items[1:], None], strict=True):
        config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        end.send(DONE)


def can_fork(config: pytest.Config) -> bool:
    """Only Linux forks a process that has loaded system libraries without a risk; a debugger needs the terminal."""
    return sys.platform.startswith("linux") and not config.getoption("usepdb") and not config.getoption("trace")
