"""Rows of stages, for compiled rings in loops, for those of thousands of nodes as whole arrays."""

from __future__ import annotations

from typing import Any

from rigid.kernel.compile import in_loops, loop


def _store_each(rows: Any, i: int, values: Any) -> None:
    for k in range(values.shape[0]):
        rows[i, k] = values[k]


@in_loops(_store_each, _nrt=False)
def store(rows: Any, i: int, values: Any) -> None:
    """Write a row; an assignment of slices would compile numpy's broadcasting with all its messages."""
    rows[i] = values


def _advance_each(start: Any, h: float, weights: Any, rows: Any, count: int) -> Any:
    result = start.copy()
    for i in range(count):
        for k in range(result.shape[0]):
            result[k] += h * weights[i] * rows[i, k]
    return result


@in_loops(_advance_each)
def advanced(start: Any, h: float, weights: Any, rows: Any, count: int) -> Any:
    """``start`` and ``h`` times the first of the rows, each with its weight."""
    result = start.copy()
    for i in range(count):
        result += h * weights[i] * rows[i]
    return result


def _along_each(force: Any, end: Any, start: Any) -> float:
    work = 0.0
    for k in range(force.shape[0]):
        work += force[k] * (end[k] - start[k])
    return work


@in_loops(_along_each, _nrt=False)
def along(force: Any, end: Any, start: Any) -> float:
    """Work of a force between two positions."""
    return float(force @ (end - start))


@loop
def work(weights: Any, force: Any, way: Any) -> float:
    """Work of a force along a way, both known at the stages, by ``work`` of :class:`flexible.time.methods.Method`."""
    total = 0.0
    for i in range(force.shape[0]):
        for j in range(way.shape[0]):
            total += force[i] * weights[i, j] * way[j]
    return total
