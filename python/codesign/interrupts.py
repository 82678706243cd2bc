"""Ctrl-C: it ends long computations on all threads, and a process that does not listen."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

from codesign._core import interrupt

GRACE = 0.6  # s that Python has to take note of an interrupt


@contextmanager
def guarded() -> Iterator[None]:
    """While the block runs, an interrupt that Python cannot take note of within GRACE ends the process.

    Native code asks every 50 ms, and KeyboardInterrupt comes out of it. A library call that asks nobody keeps Python
    from that: then temporary files are removed and the exit code is 130, as after any interrupt. For command lines;
    does nothing on another thread than the main one.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    interrupt.start_guard(reader, GRACE)
    earlier = signal.signal(signal.SIGINT, _take_note)
    earlier_descriptor = signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    try:
        yield
    finally:
        signal.set_wakeup_fd(earlier_descriptor)
        signal.signal(signal.SIGINT, earlier)
        os.write(writer, b"\0")
        os.close(writer)


def _take_note(*_: object) -> None:
    interrupt.acknowledge()
    raise KeyboardInterrupt


@contextmanager
def native_threads(count: int) -> Iterator[ThreadPoolExecutor]:
    """Threads for native computations; an exception in the block, Ctrl-C above all, ends what they compute."""
    pool = ThreadPoolExecutor(count)
    try:
        yield pool
    except BaseException:
        interrupt.stop_threads(True)
        raise
    finally:
        try:
            pool.shutdown(cancel_futures=True)
        finally:
            interrupt.stop_threads(False)


@contextmanager
def temporary(path: Path) -> Iterator[Path]:
    """A file or folder that is removed too if the guard ends the process; its maker removes it otherwise."""
    interrupt.add_temporary(path)
    try:
        yield path
    finally:
        interrupt.remove_temporary(path)
