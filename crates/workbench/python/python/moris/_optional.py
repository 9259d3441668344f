"""Packages that only some functions need, imported where they are needed."""

import importlib


def need(module, purpose, install=None):
    """The module; where it is missing, an ImportError with the line that installs it."""
    try:
        return importlib.import_module(module)
    except ImportError as reason:
        name = install or module.split(".")[0]
        raise ImportError(f"{purpose} needs the package {name}: pip install {name}") from reason


def pandas():
    return need("pandas", "a DataFrame")
