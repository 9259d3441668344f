"""FMUs with a rig and parameters: from an existing FMU, or built by cargo from the project's sources."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Literal

from . import _types as types
from ._errors import BuildError
from ._moris import pack_fmu
from ._simulation import parameters as all_parameters
from ._simulation import write_parameters
from ._types import ParameterSet, Rig, Strategy


def build_fmu(
    rig: Rig | None = None,
    parameters: ParameterSet | None = None,
    strategy: Strategy | None = None,
    *,
    output: types.Path = ".",
    base: types.Path | None = None,
    fmi: Literal[2, 3] | None = None,
    platforms: Sequence[str] | None = None,
    source: types.Path | None = None,
) -> Path:
    """Makes the washout's FMU with a rig and parameters as start values; returns its path.

    rig, parameters, strategy: as for Washout. output: directory for the FMU.

    base: an FMU of the washout, of this package's version. The new one is for its version of FMI and all of its platforms, and
    nothing is compiled. Without a base, cargo compiles the project's sources with a Rust toolchain (https://rustup.rs). Then
    fmi: 2 (default) or 3. platforms: list of names such as "linux64", "win64"; by default this machine's. source: directory of
    the sources; by default the working directory or one above it. Raises BuildError.
    """
    directory = Path(output).resolve()
    sets = [part for part in (parameters, None if strategy is None else {"strategy": strategy}) if part is not None]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "parameters.toml"
        # The rig's values are among them: every value that is not the default's.
        write_parameters(file, all_parameters(rig, sets or None))
        if base is None:
            return _compile(file, directory, 2 if fmi is None else fmi, platforms, source)
        if fmi is not None or platforms is not None or source is not None:
            raise ValueError("fmi, platforms and source are those of the base; omit them, or omit base")
        return Path(pack_fmu(base, str(file), directory))


def _compile(parameters: Path, output: Path, fmi: int, platforms: Sequence[str] | None, source: types.Path | None) -> Path:
    if fmi not in (2, 3):
        raise ValueError(f"fmi is {fmi!r}, but must be 2 or 3")
    cargo = shutil.which("cargo")
    if cargo is None:
        raise BuildError("there is no cargo; give an FMU as base=, or install a Rust toolchain from https://rustup.rs")
    command = [cargo, "build-fmu", "--model", "MorisWashout", "--fmi", str(fmi), "--output", str(output)]
    command += ["--parameters", str(parameters)]
    if platforms:
        command += ["--platform", ",".join(platforms)]
    built = subprocess.run(command, cwd=_source(source), capture_output=True, text=True)
    if built.returncode != 0:
        raise BuildError(f"cargo build-fmu failed:\n{built.stderr.strip()[-4000:]}")
    return output / f"MorisWashout{'' if fmi == 2 else '.fmi3'}.fmu"


def _source(source: types.Path | None) -> Path:
    if source is not None:
        if not (Path(source) / "build-fmu" / "Cargo.toml").exists():
            raise BuildError(f"source is {source}, but the project's sources are not there")
        return Path(source)
    for folder in (Path.cwd(), *Path.cwd().parents):
        if (folder / "build-fmu" / "Cargo.toml").exists():
            return folder
    reason = "give an FMU as base=, or give their directory as source="
    raise BuildError(f"the project's sources are not in the working directory; {reason}")
