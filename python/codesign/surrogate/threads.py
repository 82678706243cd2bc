"""Linear algebra of a few hundred points on one thread: several wait for each other longer than they compute.

On a busy machine a report took six times the processor time with two of them; and nothing depends on their number.
"""

from __future__ import annotations

from threadpoolctl import threadpool_limits


def one_thread() -> threadpool_limits:
    """A context in which BLAS computes on the thread that calls it."""
    return threadpool_limits(limits=1, user_api="blas")
