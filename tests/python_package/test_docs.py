"""Every snippet of docs/python.md and the notebook, run as they are printed."""

import os
import re
import shutil
import subprocess
import sys
import textwrap

import pytest
from conftest import ROOT, only_all_cases

PAGE = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
SNIPPETS = re.findall(r"^```python\n(.*?)^```", PAGE, flags=re.MULTILINE | re.DOTALL)


def snippets_with(*words):
    found = [snippet for snippet in SNIPPETS if any(word in snippet for word in words)]
    assert found
    return found


CLUSTERS = ("SLURMCluster", "localhost:8786")
LONGEST = 300.0
"""Time that a page's code may take [s]: a cluster whose workers never come would wait for ever."""


def run(tmp_path, code, **environment):
    """The code as a script of its own, which a LocalCluster needs."""
    script = tmp_path / "page.py"
    script.write_text("import matplotlib\nmatplotlib.use('Agg')\n" + code, encoding="utf-8")
    environment = {**os.environ, "PATH": f"{os.path.dirname(sys.executable)}:{os.environ['PATH']}", **environment}
    done = subprocess.run([sys.executable, script], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=LONGEST)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def guarded(code):
    """The code below the guard that worker processes need."""
    return "if __name__ == '__main__':\n" + textwrap.indent(code, "    ")


SETUP = next(snippet for snippet in SNIPPETS if "import moris" in snippet)


def prelude():
    """What the later snippets use: arrays and a recording."""
    return SETUP + "".join(snippet for snippet in SNIPPETS if snippet.startswith(("time =", "ride =", "recording =")))


def test_the_snippets_run_one_after_the_other(tmp_path, fmu):
    page = [snippet for snippet in SNIPPETS if not any(word in snippet for word in CLUSTERS)]
    assert len(page) >= 9
    shutil.copy(fmu, tmp_path)
    code = "".join(page)
    printed = run(tmp_path, guarded(code))
    assert "did you mean splitter.x.omega1" in printed
    assert {"ride.html", "tuned.toml", "fmu"} <= {path.name for path in tmp_path.iterdir()}


def test_comments_tell_the_values():
    names = {}
    exec(SETUP + snippets_with("outputs = moris.Washout()")[0] + snippets_with("simulation.fits")[0], names)
    assert len(names["output"]["actuator.length"]) == 6 and names["output"]["status.tiltLimited"] is True
    assert names["outputs"]["actuator.length"].shape == (2001, 6)
    assert names["simulation"]["platform.position"].shape == (2001, 3) and names["simulation"].fits is True


SBATCH = """#!/bin/sh
# Runs a batch script at once in the background, as a scheduler with free machines does.
# The submitter deletes its script as soon as the job is taken, so the job runs a copy.
for script; do :; done
job=$(mktemp "$0.XXXXXX")
cp "$script" "$job"
sh "$job" > "$job.log" 2>&1 &
echo "Submitted batch job $!"
"""
SCANCEL = """#!/bin/sh
kill "$@" 2> /dev/null
exit 0
"""


@only_all_cases
def test_the_slurm_snippet_runs_on_a_machine_that_takes_its_jobs(tmp_path):
    pytest.importorskip("dask_jobqueue", reason="needs dask_jobqueue: pip install dask-jobqueue")
    for name, text in (("sbatch", SBATCH), ("scancel", SCANCEL)):
        (tmp_path / name).write_text(text)
        (tmp_path / name).chmod(0o755)
    code = prelude() + snippets_with("SLURMCluster")[0] + "print(swept.done, swept.complete)\n"
    path = f"{tmp_path}:{os.path.dirname(sys.executable)}:{os.environ['PATH']}"
    # A machine need not reach itself by the address of its network.
    loopback = {"DASK_JOBQUEUE__SLURM__INTERFACE": "lo"}
    assert run(tmp_path, guarded(code), PATH=path, **loopback).split()[-2:] == ["36", "True"]


@only_all_cases
def test_the_kubernetes_snippet_finds_a_scheduler_at_its_port(tmp_path):
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, scheduler_port=8786, dashboard_address=None):
        code = prelude() + snippets_with("localhost:8786")[0] + "print(swept.done, swept.complete)\n"
        assert run(tmp_path, guarded(code)).split()[-2:] == ["36", "True"]


@only_all_cases
def test_the_notebook_runs_from_a_recording_to_an_fmu(tmp_path):
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(ROOT / "examples" / "09_notebook.ipynb", as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells)
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    # The FMU is built in the project's sources.
    for cell in notebook.cells:
        cell.source = cell.source.replace('source=".."', f"source={str(ROOT)!r}")
    client = NotebookClient(notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": tmp_path / "examples"}})
    client.execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    html = "".join(output["data"].get("text/html", "") for output in outputs if "data" in output)
    assert "data:image/png;base64" in html
    assert any("MorisWashout.fmu" in str(output.get("data", "")) for output in outputs)
