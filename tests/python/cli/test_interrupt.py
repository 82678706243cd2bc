"""Ctrl-C: a command ends soon, with exit code 130 and without leaving files, wherever its time goes."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

SOON = 15.0  # s on a busy machine; the work that is interrupted takes minutes

# Each prints a line, then starts on minutes of work.
WORK = {
    "the refinement of a mesh": """
surface = fem.SurfaceMesh(corners, triangles)
print("begun", flush=True)
fem.tetrahedralize(surface, 2e-4, max_vertices=10**9, time_limit=1e6)
""",
    "a factorization, which asks nobody": """
mesh = box_mesh((20, 20, 20), lambda x: x)
print("begun", flush=True)
fem.StaticSystem(mesh, steel, [fem.Support(fem.faces_with_normal([-1, 0, 0]))], solver="direct", memory_limit=1e12)
""",
    "eigenvalues by iteration": """
mesh = box_mesh((20, 20, 20), lambda x: x)
print("begun", flush=True)
fem.natural_frequencies(mesh, steel, [], 30, memory_limit=3e8)
""",
    "flights on other threads": """
from codesign.interrupts import native_threads
surface = fem.SurfaceMesh(corners, triangles)
with native_threads(2) as pool:
    print("begun", flush=True)
    list(pool.map(lambda _: fem.tetrahedralize(surface, 2e-4, max_vertices=10**9, time_limit=1e6), range(2)))
""",
}
PREAMBLE = """
import sys
import numpy as np
from codesign import fem
from codesign.interrupts import guarded
from codesign.files import replacing
from fem_meshes import box_mesh
steel = fem.Material("steel", 210e9, 0.3, 7850.0, 250e6)
corners = 0.02 * np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
triangles = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6],
             [0, 6, 4], [1, 5, 7], [1, 7, 3]]
with guarded(), replacing(sys.argv[1]) as temporary:
    temporary.write_text("half")
    try:
"""


def interrupted(command, cwd, environment):
    """Exit code, standard error, and the seconds from the signal to the end."""
    process = subprocess.Popen(
        command,
        cwd=cwd,
        env=os.environ | environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        assert process.stdout.readline() == "begun\n", process.communicate()
        time.sleep(1.0)
        assert process.poll() is None, process.communicate()
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60.0)
        return process.returncode, errors, time.monotonic() - sent
    finally:
        process.kill()


@pytest.mark.parametrize("work", WORK)
def test_native_work_ends_soon_and_leaves_no_files(work, tmp_path):
    body = "".join(f"        {line}\n" for line in WORK[work].strip().splitlines())
    program = PREAMBLE + body + "    except KeyboardInterrupt:\n        sys.exit(130)\n"
    command = [sys.executable, "-c", program, str(tmp_path / "result.txt")]
    code, errors, seconds = interrupted(command, tmp_path, {"PYTHONPATH": str(Path(__file__).parents[1])})
    assert code == 130, errors
    assert seconds < SOON
    assert list(tmp_path.iterdir()) == []


def test_a_command_ends_soon_and_says_so(tmp_path):
    part = tmp_path / "block.stl"
    corners = [[20.0 * x, 20.0 * y, 20.0 * z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    triangles = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6),
                 (0, 6, 4), (1, 5, 7), (1, 7, 3)]  # fmt: skip
    facets = [
        "facet normal 0 0 0 outer loop "
        + " ".join("vertex {} {} {}".format(*corners[i]) for i in triangle)
        + " endloop endfacet"
        for triangle in triangles
    ]
    part.write_text("solid block\n" + "\n".join(facets) + "\nendsolid block\n")
    arguments = [
        "stress",
        str(part),
        "--fix",
        "normal:-1,0,0",
        "--load",
        "normal:1,0,0: 0 0 -9",
        "--edge-length",
        "0.3",
    ]
    program = (
        "import sys; from codesign.cli import main; print('begun', flush=True); "
        f"sys.argv[1:] = {arguments!r}; main.main()"
    )
    code, errors, seconds = interrupted([sys.executable, "-c", program], tmp_path, {})
    assert code == 130, errors
    assert errors.strip().splitlines()[-1] == "interrupted"
    assert "Traceback" not in errors
    assert seconds < SOON
