"""The worker process: evaluates one design at a time for the pool that started it.

Started as `python -m codesign.execution.worker LOADER SOURCE CACHE MEMORY_MIB`. Messages are JSON documents behind a
length (four bytes, big-endian), tasks on standard input, answers on the original standard output; anything that prints
goes to standard error. The process leads its own process group and kills the whole group as soon as its parent is gone.
"""

from __future__ import annotations

import contextlib
import ctypes
import faulthandler
import importlib
import json
import os
import queue
import resource
import signal
import struct
import sys
import threading
import time
import traceback
from typing import IO, TYPE_CHECKING, Any, cast

if TYPE_CHECKING:  # a worker imports what its study needs, nothing more
    from codesign.problem.evaluation import Evaluation
    from codesign.problem.protocols import LazyProblem, PartCache, Problem

LENGTH = struct.Struct(">I")
PR_SET_PDEATHSIG = 1  # linux/prctl.h
MEBIBYTE = 1 << 20


def write_message(stream: IO[bytes], message: dict[str, Any]) -> None:
    """Writes one document; raises ValueError if it holds NaN or infinity."""
    payload = json.dumps(message, allow_nan=False).encode()
    stream.write(LENGTH.pack(len(payload)) + payload)
    stream.flush()


def read_message(stream: IO[bytes]) -> dict[str, Any] | None:
    """Reads one document; None at the end of the stream."""
    head = stream.read(LENGTH.size)
    if len(head) < LENGTH.size:
        return None
    payload = stream.read(LENGTH.unpack(head)[0])
    document: dict[str, Any] = json.loads(payload)
    return document


def load(loader: str, source: str) -> Problem:
    """The study: `loader` is `module:function`, called with `source`."""
    module, _, function = loader.partition(":")
    study: Problem = getattr(importlib.import_module(module), function)(source)
    return study


def evaluate(study: Problem, task: dict[str, Any], cache: PartCache | None, memory_mib: int = 0) -> dict[str, Any]:
    """One evaluation as a message; an exception becomes a failed one that names it. task: see `Task.message`."""
    exhausted, design = False, task["design"]
    try:
        document = _evaluated(study, task, cache).to_dict()
        json.dumps(document, allow_nan=False)
    except BaseException as error:  # SystemExit too: nothing that an evaluation raises may end the worker
        exhausted = isinstance(error, MemoryError)
        reason = f"{type(error).__name__}: {error}"
        if exhausted:
            reason = f"memory limit of {memory_mib} MiB exceeded" if memory_mib else "out of memory"
            reason += " (execution.memory_limit_mib): larger elements of the parts or a larger limit are needed"
        provenance = {"traceback": traceback.format_exc(limit=-8)}
        document = {"design": design, "status": "failed", "reason": reason, "provenance": provenance}
    return {"evaluation": document, "exhausted": exhausted}


def _evaluated(study: Problem, task: dict[str, Any], cache: PartCache | None) -> Evaluation:
    if task["rivals"] is not None:
        return cast("LazyProblem", study).evaluate_lazily(task["design"], task["rivals"], cache=cache)
    return study.evaluate(task["design"], trajectory=task["trajectory"], cache=cache)


def address_space() -> int:
    """Bytes that this process has mapped; 0 where the kernel does not say."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123 - a file of the kernel
            return int(file.read().split()[0]) * resource.getpagesize()
    except (OSError, ValueError):
        return 0


def limit_memory(limit_mib: int, most: float) -> None:
    """Lets the address space grow by at most `limit_mib` from here, to `most` bytes; more fails as MemoryError."""
    here = address_space()
    if limit_mib <= 0 or here == 0:
        return
    with contextlib.suppress(OSError, ValueError):
        ceiling = int(min(here + limit_mib * MEBIBYTE, most))
        resource.setrlimit(resource.RLIMIT_AS, (ceiling, resource.getrlimit(resource.RLIMIT_AS)[1]))


def die_with_parent() -> None:
    """Has the kernel kill this process when its parent is gone (Linux), even in a native call that never returns."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def read_tasks(stream: IO[bytes], tasks: queue.SimpleQueue[dict[str, Any]]) -> None:
    """Feeds the queue; at the end of the stream (parent closed it, or died) kills the process group."""
    while (message := read_message(stream)) is not None:
        tasks.put(message)
    os.killpg(0, signal.SIGKILL)


def main(arguments: list[str]) -> None:
    """Loads the study, says so, then answers tasks until the parent goes away."""
    loader, source, cache_path, memory_mib, kept_mib = arguments
    die_with_parent()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    faulthandler.enable()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    tasks: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
    reader = threading.Thread(target=read_tasks, args=(os.fdopen(os.dup(0), "rb"), tasks), daemon=True)
    reader.start()
    try:
        study = load(loader, source)
        cache = None
        if cache_path:
            from codesign.storage.cache import SqliteCache

            cache = SqliteCache(cache_path)
    except BaseException as error:
        traceback.print_exc()
        write_message(answers, {"error": f"{type(error).__name__}: {error}"})
        return
    write_message(answers, {"ready": study.hash, "identity": study.identity.document()})
    most = address_space() + (int(memory_mib) + int(kept_mib)) * MEBIBYTE
    importlib.import_module("codesign._core").limit_kept_meshes(int(kept_mib) * MEBIBYTE)
    while True:
        task = tasks.get()
        limit_memory(int(memory_mib), most)
        started = time.perf_counter()
        answer = evaluate(study, task, cache, int(memory_mib))
        write_message(answers, answer | {"seconds": time.perf_counter() - started})


if __name__ == "__main__":
    main(sys.argv[1:])
