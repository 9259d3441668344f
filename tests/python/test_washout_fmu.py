"""`moris simulate` and `moris bench` with the washout's own FMU as another's."""

import csv
import os
import re
import subprocess
from pathlib import Path

from conftest import ROOT, TARGET

FMUS = Path(os.environ.get("MORIS_FMUS", TARGET / "fmu"))
FMU = FMUS / "MorisWashout.fmu"
MAP = ROOT / "examples" / "washout-map.toml"
MORIS = [os.environ["MORIS"]] if "MORIS" in os.environ else ["cargo", "run", "--quiet", "--bin", "moris", "--"]


def moris(*arguments):
    return subprocess.run([*MORIS, *map(str, arguments)], cwd=ROOT, capture_output=True, text=True)


def written(path, *start):
    """The map with these start values."""
    path.write_text(MAP.read_text().replace("[start]", "\n".join(["[start]", *start])))
    return path


def rows(file):
    with file.open() as opened:
        return list(csv.DictReader(opened))


def test_the_bench_gives_our_fmu_the_figures_of_its_strategy(tmp_path):
    start = [f'"scale.specificForce.{axis}" = 1' for axis in "xyz"]
    own = written(tmp_path / "map.toml", "strategy = 1", *start)
    bench = ["bench", "--drive", "lane-change", "--rig", "default", "--strategy", "classical", "--report", tmp_path]
    done = moris(*bench, "--washout", FMU, "--map", own)
    assert done.returncode == 0 and "MorisWashout, own scale" in done.stdout, done.stdout + done.stderr
    table = rows(tmp_path / "bench.csv")
    ours = next(row for row in table if (row["washout"], row["scale"]) == ("classical", "1"))
    other = next(row for row in table if row["washout"] == "MorisWashout")
    for name, value in ours.items():
        if name.startswith(("RMS error", "shape", "stroke")) and value:
            assert abs(float(value) - float(other[name])) <= 1.001e-3, name


def test_the_command_compares_an_fmu_and_says_what_is_wrong(tmp_path):
    subprocess.run(["python3", ROOT / "examples" / "recording.py", tmp_path / "ride.csv"], check=True)
    simulate = ["simulate", tmp_path / "ride.csv", "--no-bound", "--strategy", "classical", "--report", tmp_path, "--washout"]
    done = moris(*simulate, FMU, "--map", written(tmp_path / "map.toml", "strategy = 1"))
    assert done.returncode == 0 and "motion MorisWashout:" in done.stdout, done.stderr
    ours, theirs = rows(tmp_path / "ride.outputs.csv"), rows(tmp_path / "ride.MorisWashout.outputs.csv")
    poses = [name for name in ours[0] if name.startswith(("platform.position", "platform.orientation"))]
    assert len(poses) == 6 and all(a[name] == b[name] for a, b in zip(ours, theirs) for name in poses)

    done = moris(*simulate, FMU, "--map", tmp_path / "no.toml")
    assert done.returncode == 1 and "no.toml" in done.stderr
    done = moris(*simulate, tmp_path / "no.fmu", "--map", MAP)
    assert done.returncode == 1 and "no.fmu" in done.stderr
    done = moris(*simulate, FMU)
    assert done.returncode == 2 and "--map" in done.stderr


def with_elements(text):
    """The map with the elements of array variables: `x` of three is `[1]`."""
    for places in ("xyz", ("roll", "pitch", "yaw")):
        for number, place in enumerate(places, 1):
            text = re.sub(rf'((?:specificForce|angularVelocity|position|orientation))\.{place}"', rf'\1[{number}]"', text)
    return text


def test_an_fmu_of_fmi_3_is_stepped_with_scalars_and_with_arrays(tmp_path):
    subprocess.run(["python3", ROOT / "examples" / "recording.py", tmp_path / "ride.csv"], check=True)
    own = written(tmp_path / "map.toml", "strategy = 1")
    # It takes no slopes: each input is held over a step.
    own.write_text("step = 0.001\n" + own.read_text())
    arrays = tmp_path / "arrays.toml"
    arrays.write_text(with_elements(own.read_text()))
    assert arrays.read_text().count("[3]") == 5
    simulate = ["simulate", tmp_path / "ride.csv", "--no-bound", "--strategy", "classical", "--report", tmp_path, "--washout"]
    for name, file in (("MorisWashout.fmi3", own), ("MorisWashout.fmi3.arrays", arrays)):
        done = moris(*simulate, FMUS / f"{name}.fmu", "--map", file)
        assert done.returncode == 0, done.stderr
    ours, scalars, vectors = (
        rows(tmp_path / f"ride.{name}outputs.csv") for name in ("", "MorisWashout.fmi3.", "MorisWashout.fmi3.arrays.")
    )
    assert scalars == vectors
    poses = [name for name in ours[0] if name.startswith(("platform.position", "platform.orientation"))]
    apart = max(abs(float(a[name]) - float(b[name])) for a, b in zip(ours, scalars) for name in poses)
    moved = max(abs(float(a[name]) - float(ours[0][name])) for a in ours for name in poses)
    assert len(ours) == len(scalars) and moved > 0.05 and apart < 0.02 * moved, (apart, moved)

    done = moris(*simulate, FMUS / "MorisWashout.fmi3.arrays.fmu", "--map", own)
    assert done.returncode == 1 and "vehicle.specificForce" in done.stderr
    whole = written(tmp_path / "whole.toml")
    whole.write_text(whole.read_text().replace('"vehicle.specificForce.x"', '"vehicle.specificForce"'))
    done = moris(*simulate, FMUS / "MorisWashout.fmi3.arrays.fmu", "--map", whole)
    assert done.returncode == 1 and '"vehicle.specificForce[1]"' in done.stderr, done.stderr
