"""FMUs, built by cargo from the project's sources."""

import shutil
import subprocess
import tempfile
from pathlib import Path

from ._simulation import parameters as all_parameters
from ._simulation import write_parameters


class BuildError(RuntimeError):
    """The FMU cannot be built: the toolchain or the sources are missing, or cargo failed."""


def build_fmu(rig=None, parameters=None, strategy=None, *, output=".", fmi=2, platforms=None, source=None):
    """Builds the washout's FMU with a rig and parameters as start values; returns its path.

    rig, parameters, strategy: as for Washout. output: directory for the FMU. fmi: 2 or 3. platforms: list of names such as
    "linux64", "win64"; by default this machine's. source: directory of the project's sources; by default the working
    directory or one above it. A Rust toolchain has to be installed (https://rustup.rs). Raises BuildError.
    """
    if fmi not in (2, 3):
        raise ValueError(f"fmi is {fmi!r}, but must be 2 or 3")
    cargo = shutil.which("cargo")
    if cargo is None:
        raise BuildError("there is no cargo; install a Rust toolchain from https://rustup.rs")
    source = _source(source)
    output = Path(output).resolve()
    sets = [part for part in (parameters, None if strategy is None else {"strategy": strategy}) if part is not None]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "parameters.toml"
        # The rig's values are among them: every value that is not the default's.
        write_parameters(file, all_parameters(rig, sets or None))
        command = [cargo, "build-fmu", "--model", "MorisWashout", "--fmi", str(fmi), "--output", str(output)]
        command += ["--parameters", str(file)]
        if platforms:
            command += ["--platform", ",".join(platforms)]
        built = subprocess.run(command, cwd=source, capture_output=True, text=True)
    if built.returncode != 0:
        raise BuildError(f"cargo build-fmu failed:\n{built.stderr.strip()[-4000:]}")
    return output / "MorisWashout.fmu"


def _source(source):
    if source is not None:
        if not (Path(source) / "build-fmu" / "Cargo.toml").exists():
            raise BuildError(f"source is {source}, but the project's sources are not there")
        return Path(source)
    for folder in (Path.cwd(), *Path.cwd().parents):
        if (folder / "build-fmu" / "Cargo.toml").exists():
            return folder
    raise BuildError("the project's sources are not in the working directory; give their directory as source=")
