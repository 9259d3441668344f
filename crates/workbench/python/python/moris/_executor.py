"""Work by a concurrent.futures.Executor, such as a pool of processes or that of a Dask client."""

from __future__ import annotations

import hashlib
import os
import pickle
from collections.abc import Callable
from concurrent.futures import Executor, Future, wait
from typing import Any

from ._errors import ExecutorError, MorisError

LOOK = 0.2
"""Time between two questions whether to wait any longer [s]."""
MOST_CONTEXTS = 4
"""Contexts that a process keeps."""

_contexts: dict[str, Any] = {}


def _work(key: str, payload: bytes | None, function: Callable[..., Any], arguments: tuple[Any, ...]) -> list[Any]:
    """The result of function(context, *arguments), or nothing where this process lacks the context and the payload."""
    if payload is not None and key not in _contexts:
        while len(_contexts) >= MOST_CONTEXTS:
            _contexts.pop(next(iter(_contexts)), None)
        make, given = pickle.loads(payload)
        _contexts[key] = make(*given)
    context = _contexts.get(key)
    return [] if context is None else [function(context, *arguments)]


class Workers:
    """The workers of an executor. The context make(*arguments) goes to each that lacks it."""

    def __init__(self, executor: Executor, count: int | None, make: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
        if not isinstance(executor, Executor):
            raise TypeError(f"executor must be a concurrent.futures.Executor, not {type(executor).__name__}")
        self.count = count or os.cpu_count() or 1
        self._executor = executor
        self._payload = pickle.dumps((make, arguments))
        self._key = hashlib.sha256(self._payload).hexdigest()

    def submit(self, *task: Any, payload: bytes | None = None) -> Future[list[Any]]:
        """Begins function(context, *arguments) of a task (function, *arguments) on some worker."""
        try:
            return self._executor.submit(_work, self._key, payload, task[0], task[1:])
        except Exception as reason:
            raise _lost(reason) from reason

    def result(self, future: Future[list[Any]], *task: Any, cancelled: Callable[[], bool] = lambda: False) -> Any:
        """The result of a task that was submitted, or None where `cancelled()` says to wait no longer."""
        while not cancelled():
            if not wait([future], LOOK).done:
                continue
            try:
                found = future.result()
            except (MorisError, TypeError, ValueError):
                raise
            except Exception as reason:
                raise _lost(reason) from reason
            if found:
                return found[0]
            future = self.submit(*task, payload=self._payload)
        return None


def _lost(reason: Exception) -> ExecutorError:
    return ExecutorError(f"the executor lost a task ({type(reason).__name__}: {reason}); start it again and repeat the call")
