"""The shared libraries for Linux inside the FMUs, as the dynamic linker sees them."""

import io
import sys
import zipfile

import pytest
from conftest import TARGET, only_all_cases
from elftools.elf.elffile import ELFFile

# The oldest that Rust supports: RHEL 7 and everything since.
OLDEST_GLIBC = (2, 17)
# All that a library may ask for: the C library, its loader, and the one that unwinds the stack.
LIBRARIES = {"libc.so.6", "libgcc_s.so.1", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
NAMES = [f"{model}.{kind}" for model in ("MorisWashout", "Motorcycle", "StewartPlatform") for kind in ("fmu", "fmi3.fmu")]


def libraries(fmu):
    """The libraries for Linux in an FMU, by their paths."""
    with zipfile.ZipFile(fmu) as archive:
        names = [name for name in archive.namelist() if name.startswith("binaries/") and name.endswith(".so")]
        return {name: ELFFile(io.BytesIO(archive.read(name))) for name in names}


def version(text):
    return tuple(int(number) for number in text.split("."))


# Without link-time optimisation, as in the default run, a library refers to newer functions that it does not call.
@only_all_cases
@pytest.mark.skipif(sys.platform != "linux", reason="the FMUs are those for the machine on which the tests run")
@pytest.mark.parametrize("name", NAMES)
def test_a_library_loads_on_every_linux_since_2012(name):
    path = TARGET / "fmu" / name
    assert path.exists(), f"{path} is missing: run `cargo build-fmu` and `cargo build-fmu --fmi 3`"
    found = libraries(path)
    assert found
    for where, library in found.items():
        needed = {tag.needed for tag in library.get_section_by_name(".dynamic").iter_tags("DT_NEEDED")}
        assert needed <= LIBRARIES, where
        versions = [
            version(auxiliary.name.removeprefix("GLIBC_"))
            for _, auxiliaries in library.get_section_by_name(".gnu.version_r").iter_versions()
            for auxiliary in auxiliaries
            if auxiliary.name.startswith("GLIBC_")
        ]
        assert versions and max(versions) <= OLDEST_GLIBC, f"{where} needs glibc {max(versions)}"
        exported = [
            symbol.name
            for symbol in library.get_section_by_name(".dynsym").iter_symbols()
            if symbol["st_info"]["bind"] != "STB_LOCAL" and symbol["st_shndx"] != "SHN_UNDEF"
        ]
        assert len(exported) > 40 and all(symbol.startswith(("fmi2", "fmi3")) for symbol in exported), where
