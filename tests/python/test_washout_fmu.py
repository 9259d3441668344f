"""`moris simulate` and `moris bench` with the washout's own FMU as another's."""

import csv
import os
import subprocess
from pathlib import Path

from conftest import ROOT

FMU = Path(os.environ.get("MORIS_FMUS", ROOT / "target" / "fmu")) / "MorisWashout.fmu"
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
    assert done.returncode == 0 and "parameters MorisWashout:" in done.stdout, done.stderr
    ours, theirs = rows(tmp_path / "ride.outputs.csv"), rows(tmp_path / "ride.MorisWashout.outputs.csv")
    poses = [name for name in ours[0] if name.startswith(("platform.position", "platform.orientation"))]
    assert len(poses) == 6 and all(a[name] == b[name] for a, b in zip(ours, theirs) for name in poses)

    done = moris(*simulate, FMU, "--map", tmp_path / "no.toml")
    assert done.returncode == 1 and "no.toml" in done.stderr
    done = moris(*simulate, tmp_path / "no.fmu", "--map", MAP)
    assert done.returncode == 1 and "no.fmu" in done.stderr
    done = moris(*simulate, FMU)
    assert done.returncode == 2 and "--map" in done.stderr
