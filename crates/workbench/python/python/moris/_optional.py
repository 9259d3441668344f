"""Packages that only some functions need, imported where they are needed."""

from __future__ import annotations

import importlib
from typing import Any


def need(module: str, purpose: str, install: str | None = None) -> Any:
    """The module; where it is missing, an ImportError with the line that installs it."""
    try:
        return importlib.import_module(module)
    except ImportError as reason:
        name = install or module.split(".")[0]
        raise ImportError(f"{purpose} needs the package {name}: pip install {name}") from reason


def pandas() -> Any:
    return need("pandas", "a DataFrame")
