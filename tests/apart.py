"""Each file of tests runs in a process of its own, forked from the one that collected them all, a file for each core.

Compiled kernels, VTK and Mesa's compiler stay in a process until it ends: together they take more than a gigabyte, the
dearest file alone little more than half of one. It also keeps files from seeing what others left in caches. The fork
begins with all modules imported and the flexible kernels loaded, so it costs next to nothing. Where there is no safe
fork, and under a debugger, everything runs in one process.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
import warnings
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from typing import Any

import pytest

#: what a child tells: a hook of pytest by name and its arguments, a report as plain data; or that an item is done
Told = tuple[str, dict[str, Any]]
DONE: Told = ("done", {})

#: files at once, at most: each may take half a gigabyte
MOST = 4
#: files that are named at the end with their memory
DEAREST = 3


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


class Child:
    """In the parent: the process of one file, the tests it has still to do, what it told of the first of them."""

    def __init__(self, items: list[pytest.Item], apart: Apart) -> None:
        self.items, self.told = items, list[Told]()
        self.file = items[0].nodeid.partition("::")[0]
        self.end, childs = Pipe()
        with warnings.catch_warnings():  # OpenBLAS has threads, and its own provision for a fork
            warnings.simplefilter("ignore", DeprecationWarning)
            self.process = os.fork()
        if self.process:
            childs.close()
            return
        status = 1
        try:
            for other in [self, *apart.children]:
                other.end.close()
            _run(items, childs, apart)
            status = 0
        finally:
            os._exit(status)

    def stop(self) -> tuple[int, float]:
        """End of the process, which has nothing more to tell; its status, and the most memory [MB] of it or its own."""
        self.end.close()
        _, status, used = os.wait4(self.process, 0)
        return status, used.ru_maxrss / 1024


class Apart:
    """In the parent: hands the files to children, as many at once as there are cores; tells pytest what they say."""

    def __init__(self) -> None:
        self.children: list[Child] = []
        self.at_once = min(len(os.sched_getaffinity(0)), MOST)
        self.memory: dict[str, float] = {}  # of each file, the most [MB] that a process of it had

    def pytest_runtestloop(self, session: pytest.Session) -> bool | None:
        collected = session.testsfailed == 0 or session.config.getoption("continue_on_collection_errors")
        if not collected or session.config.getoption("collectonly"):
            return None  # pytest's own loop says so
        files: dict[Any, list[pytest.Item]] = {}
        for item in session.items:
            files.setdefault(item.path, []).append(item)
        session.config._tmp_path_factory.getbasetemp()  # one for all: a child that ends does not clear up after itself
        outer_first = sorted(files, key=lambda path: len(path.parts))  # they take longest
        waiting = [files[path] for path in outer_first]
        try:
            while waiting or self.children:
                while waiting and len(self.children) < self.at_once:
                    self.children.append(Child(waiting.pop(0), self))
                ready = wait([child.end for child in self.children])
                for child in [child for child in self.children if child.end in ready]:
                    waiting[:0] = self._hear(child)
                    if session.shouldfail:
                        raise session.Failed(session.shouldfail)
                    if session.shouldstop:
                        raise session.Interrupted(session.shouldstop)
        finally:
            for child in self.children:
                os.kill(child.process, signal.SIGTERM)
                child.stop()
        return True

    def _hear(self, child: Child) -> list[list[pytest.Item]]:
        """Take what the child has to tell; tests that its end leaves without a process are given back."""
        try:
            told: Told = child.end.recv()
        except (EOFError, ConnectionError):
            told = "died", {}
        if told[0] not in ("done", "died"):
            child.told.append(told)
            return []
        item, *others = child.items
        if told != DONE:
            died = f"the process of this file ended: status {self._end(child)}"
            report = pytest.TestReport(item.nodeid, item.location, {}, "failed", died, "call")
            _pass_on(item, child.told, report)
            return [others] if others else []
        _pass_on(item, child.told)
        child.items, child.told = others, []
        if not others:
            self._end(child)
        return []

    def _end(self, child: Child) -> int:
        self.children.remove(child)
        status, memory = child.stop()
        self.memory[child.file] = max(memory, self.memory.get(child.file, 0.0))
        return status

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        for file, memory in sorted(self.memory.items(), key=lambda of: -of[1])[:DEAREST]:
            terminalreporter.write_line(f"{self.at_once} files at once; the most memory: {memory:.0f} MB, {file}")


def _pass_on(item: pytest.Item, told: list[Told], *more: pytest.TestReport) -> None:
    """One test, told at once, so that the lines of files that run side by side are not mixed."""
    hook = item.ihook
    hook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    for what, of in told:
        if what == "report":
            report = hook.pytest_report_from_serializable(config=item.config, data=of)
            hook.pytest_runtest_logreport(report=report)
        else:
            hook.pytest_warning_recorded.call_historic(kwargs=of)
    for report in more:
        hook.pytest_runtest_logreport(report=report)
    hook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)


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
