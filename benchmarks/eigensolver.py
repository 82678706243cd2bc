"""Natural modes of parts by our eigensolver and by Spectra's; table of a decision. Needs Debian's libspectra-dev.

    cmake --build build/python --target benchmark_eigensolver
    python benchmarks/eigensolver.py [--program build/python/benchmarks/benchmark_eigensolver] [--repeats 5]

CPU seconds after the factor, which both use, the least of the repeats; tolerance 1e-9 for both.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

from symbolic_factor import BUILT, DESIGNS, write_model

import codesign
from codesign import _core
from codesign.chain.chain import stress_settings
from codesign.parts.load_case import part_case

MODES = (1, 6, 20)


def main() -> None:
    """One row per part and number of modes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=BUILT.with_name("benchmark_eigensolver"))
    parser.add_argument("--repeats", type=int, default=5)
    given = parser.parse_args()
    study = codesign.load_study("ironcub_paper")
    print("| part | equations | modes | ours, s | Spectra, s | difference of frequency | residuals |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for name, part in study.build_parts(DESIGNS[0]).items():
        case = part_case(part, stress_settings(study.config, name))
        with tempfile.TemporaryDirectory() as folder:
            write_model(_core.analyze_part(case).mesh, case, Path(folder) / "model")
            for modes in MODES:
                command = [str(given.program), f"{folder}/model", str(modes), str(given.repeats)]
                row = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)
                ours, spectra = row["residuals"]
                print(
                    f"| {name} | {row['equations']} | {modes} | {row['ours']:.3f} | {row['spectra']:.3f} "
                    f"| {row['difference']:.1e} | {ours:.1e} / {spectra:.1e} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
