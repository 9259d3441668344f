"""Work on a Dask cluster: tasks that any worker can do again, and errors that say what to do.

A task needs nothing that only one worker has. Its context is a task, too, which the scheduler has done again where the
worker that held it is lost.
"""

from __future__ import annotations

import hashlib
import pickle
import threading
import time
import warnings
from collections.abc import Callable, Iterable
from typing import Any

from ._errors import ClusterError
from ._optional import need

REPEATS = 5
"""Times that a task is sent again whose workers were lost until the scheduler gave it up."""
PATIENCE = 10.0
"""Time without a scheduler after which it counts as lost [s]."""
LOOK = 0.2
"""Time between two looks at the scheduler [s]."""
LONGEST_WITHOUT_WORKERS = 60.0
"""Time without any worker after which there is a warning [s]."""
MOST_CONTEXTS = 4
"""Contexts that a process keeps."""

_contexts: dict[str, Any] = {}


def _context(key: str, payload: bytes) -> Any:
    """The context in a payload, made once in a process."""
    if key not in _contexts:
        while len(_contexts) >= MOST_CONTEXTS:
            _contexts.pop(next(iter(_contexts)), None)
        make, arguments = pickle.loads(payload)
        _contexts[key] = make(*arguments)
    return _contexts[key]


def _same(payload: bytes) -> bytes:
    return payload


def _work(key: str, payload: bytes, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    return function(_context(key, payload), *arguments)


class Cluster:
    """The workers of a dask.distributed.Client, with the context make(*arguments) on each that needs it."""

    def __init__(self, client: Any, make: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
        need("distributed", "a cluster")
        if not hasattr(client, "scheduler_info"):
            raise TypeError(f"client must be a dask.distributed.Client, not {type(client).__name__}")
        if client.asynchronous:
            raise TypeError("client is asynchronous; make one without asynchronous=True")
        self._client = client
        self._missing_since: float | None = None
        self._warn_after = time.monotonic() + LONGEST_WITHOUT_WORKERS
        payload = pickle.dumps((make, arguments))
        self._key = hashlib.sha256(payload).hexdigest()
        self._payload = self._submit(_same, payload, key=f"moris-{self._key}")

    def threads(self) -> int:
        """Number of threads of all workers, 1 at least."""
        return max(1, sum(self._client.nthreads().values()))

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Begins function(context, *arguments) on some worker."""
        return self._submit(_work, self._key, self._payload, function, arguments, pure=False)

    def result(self, future: Any, cancelled: Callable[[], bool] = lambda: False) -> Any:
        """The result of a task, or None where `cancelled()` says to wait no longer.

        Raises ClusterError where the scheduler is lost, or the task with its workers again and again; otherwise the task's
        own exception.
        """
        from distributed.client import FutureCancelledError
        from distributed.comm.core import CommClosedError
        from distributed.scheduler import KilledWorker

        repeats = 0
        while self._waited(future, cancelled):
            try:
                # It is there: result(timeout=...) of a future that is not may fail with an error of its own.
                return future.result()
            except KilledWorker as reason:
                repeats += 1
                if repeats > REPEATS:
                    raise ClusterError(f"a task lost its workers {repeats} times; their logs say why: {reason}") from reason
                future.retry()
            except (FutureCancelledError, CommClosedError) as reason:
                raise _lost(reason) from reason
            except ModuleNotFoundError as reason:
                raise ClusterError(f"a worker lacks a package ({reason}); install moris-washout on every worker") from reason
        return None

    def _waited(self, future: Any, cancelled: Callable[[], bool]) -> bool:
        """True once the task is done, False where `cancelled()` says to wait no longer."""
        done = threading.Event()
        future.add_done_callback(lambda _: done.set())
        while not done.wait(LOOK):
            if cancelled():
                return False
            if self._is_lost():
                raise _lost("no answer")
            self._warn_without_workers()
        return not cancelled()

    def _warn_without_workers(self) -> None:
        """Warns once if no worker has come for long."""
        if time.monotonic() > self._warn_after:
            self._warn_after = float("inf")
            if not self._client.nthreads():
                address = self._client.scheduler.address
                warnings.warn(
                    f"no worker has joined the Dask cluster for {LONGEST_WITHOUT_WORKERS:g} s; the workers must run, and reach the "
                    f"scheduler at {address} (a cluster's option interface=... chooses another network)",
                    stacklevel=2,
                )

    def cancel(self, futures: Iterable[Any]) -> None:
        """Cancels tasks, as far as there is still a scheduler."""
        if self._client.status == "running":
            self._client.cancel(list(futures), force=True)

    def _submit(self, *arguments: Any, **options: Any) -> Any:
        try:
            return self._client.submit(*arguments, **options)
        except Exception as reason:
            raise _lost(reason) from reason

    def _is_lost(self) -> bool:
        if self._client.status == "running":
            self._missing_since = None
            return False
        self._missing_since = self._missing_since or time.monotonic()
        return bool(self._client.status == "closed") or time.monotonic() - self._missing_since > PATIENCE


def _lost(reason: object) -> ClusterError:
    why = str(reason) or type(reason).__name__
    return ClusterError(f"the Dask cluster's scheduler is lost ({why}); start a cluster again and repeat the call")
