"""Progress: a bar of tqdm, a function of the caller, or nothing."""

from __future__ import annotations

import sys

from ._types import Show


class Progress:
    """Shows how much is done.

    show: True for a bar, False for none. None is a bar where standard error is a terminal, or in a notebook. A function is
        called with (done, total, text).
    """

    def __init__(self, show: Show, total: int | None, text: str, unit: str) -> None:
        self.total = total
        self._function = show if callable(show) else None
        self._bar = None
        if self._function is None and (show or (show is None and _someone_looks())):
            from tqdm.auto import tqdm

            self._bar = tqdm(total=total, desc=text, unit=unit)

    def to(self, done: int, text: str) -> None:
        """So many are done."""
        if self._function is not None:
            self._function(done, self.total, text)
        elif self._bar is not None:
            self._bar.set_description(text, refresh=False)
            self._bar.update(done - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


def _someone_looks() -> bool:
    return sys.stderr.isatty() or "ipykernel" in sys.modules
