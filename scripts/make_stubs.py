"""Regenerates python/codesign/_core/*.pyi from the compiled module; with --check only says whether it is up to date."""

import subprocess
import sys
import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
STUB_DIR = REPOSITORY / "python" / "codesign" / "_core"


def generate(folder: Path) -> dict[str, str]:
    """Stub files of codesign._core by path relative to its folder, formatted."""
    subprocess.run(
        [sys.executable, "-m", "pybind11_stubgen", "codesign._core", "--output-dir", str(folder), "--exit-code"],
        check=True,
        capture_output=True,
    )
    root = folder / "codesign" / "_core"
    subprocess.run(
        [sys.executable, "-m", "ruff", "format", "--quiet", "--isolated", "--line-length=120", str(root)],
        check=True,
        cwd=REPOSITORY,
    )
    return {str(p.relative_to(root)): p.read_text() for p in sorted(root.rglob("*.pyi"))}


def main() -> int:
    """Writes or checks the stubs; exit code 1 if a check finds a difference."""
    with tempfile.TemporaryDirectory() as folder:
        new = generate(Path(folder))
    old = {str(p.relative_to(STUB_DIR)): p.read_text() for p in sorted(STUB_DIR.rglob("*.pyi"))}
    if "--check" in sys.argv:
        for name in sorted(set(old) | set(new)):
            if old.get(name) != new.get(name):
                print(f"{STUB_DIR / name} differs from the compiled module: run `make stubs`")
        return int(old != new)
    for name, text in new.items():
        (STUB_DIR / name).parent.mkdir(parents=True, exist_ok=True)
        (STUB_DIR / name).write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
