"""What runs of many designs cost besides their evaluations, and how soon their reports can be read.

python benchmarks/optimizer/scale.py run [--evaluations 20000]          a run of the stand-in, what reads it, resuming
python benchmarks/optimizer/scale.py grow RUN BIG [--designs 10000]     a run's designs again and again, a little moved
python benchmarks/optimizer/scale.py page BIG/report.html               the page in headless Chromium (playwright)
"""

from __future__ import annotations

import argparse
import dataclasses
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from standin import standin

from codesign.problem.design_space import DesignSpace
from codesign.search.optimization import optimize
from codesign.storage.records import Grid, Record
from codesign.storage.runs import load_run
from codesign.storage.store import RunStore

MARKS = (1000, 5000, 10_000, 20_000)
STRETCH = 500  # designs before each mark over which the cost is taken
SHARE = 0.02  # standard deviation of moved objectives over their values
READERS = {
    "`codesign runs`": "from codesign.storage.runs import list_runs; list_runs({run!r})",
    "table, CSV": "from codesign.storage import runs, tables; "
    "tables.export(runs.load_run({run!r}), {run!r} + '/t.csv')",
    "table, Parquet": "from codesign.storage import runs, tables; "
    "tables.export(runs.load_run({run!r}), {run!r} + '/t.parquet')",
    "read as DataFrame": "import pandas; pandas.read_parquet({run!r} + '/t.parquet')",
    "`codesign report`": "from codesign.report import write_report; "
    "write_report({run!r}, compute=False, figures=False)",
}
RESUMING = {
    "`codesign resume`": "from codesign.search.optimization import resume; resume({run!r}, cache=None, workers=1)",
}
ACTIONS = {
    "all rows of the table": "table.filter = 'all'; drawTable()",
    "last design selected": "select(designs.length - 1)",
}
LOOK = """window.drawn = {};
const look = () => {
  for (const node of document.querySelectorAll('.js-plotly-plot'))
    if (!(node.id in drawn) && node.querySelector('.points path, .lines path')) drawn[node.id] = performance.now();
  requestAnimationFrame(look);
};
requestAnimationFrame(look);"""


def peak() -> float:
    """Largest memory of this process [MiB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def run(evaluations: int) -> None:
    """CPU of the main process an evaluation, before each of MARKS; then what `read` and resuming cost."""
    spent: dict[int, float] = {}

    def note(progress: Any) -> None:
        spent.setdefault(progress.feasible + progress.infeasible, time.process_time())

    with tempfile.TemporaryDirectory() as folder:
        out = f"{folder}/run"
        optimize(standin(), out=out, population=25, evaluations=evaluations, cache=None, progress=note, workers=1)
        print(f"| after | CPU ms an evaluation, over {STRETCH} |\n| --- | --- |")
        for mark in (mark for mark in MARKS if mark <= evaluations):
            print(f"| {mark} | {1e3 * (spent[mark] - spent[mark - STRETCH]) / STRETCH:.2f} |")
        workers = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        print(f"\nmain process {peak():.0f} MiB, worker {workers:.0f} MiB\n")
        read(Path(out), READERS | RESUMING)


def read(out: Path, readers: dict[str, str]) -> None:
    """CPU and memory of what reads a run, each in a new process."""
    known = load_run(out)
    print(
        f"| {len(known.search_records)} designs, {len(known.front)} on the front | CPU s | MiB |\n| --- | --- | --- |"
    )
    for words, code in readers.items():
        print(f"| {words} | {measured(code.format(run=str(out)))} |", flush=True)


def measured(code: str) -> str:
    """CPU seconds and memory [MiB] of a new process that runs this."""
    tell = "import resource, re; u = resource.getrusage(resource.RUSAGE_SELF); "
    tell += "m = int(re.search(r'VmHWM:\\s*(\\d+)', open('/proc/self/status').read())[1]) / 1024; "
    tell += "print(f'{u.ru_utime + u.ru_stime:.1f} | {m:.0f}')"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\n{tell}"], check=True, capture_output=True, text=True, env=dict(os.environ)
    )
    return done.stdout.splitlines()[-1]


def moved(grid: Grid, space: DesignSpace, taken: set[Grid], random: np.random.Generator) -> Grid:
    """A design near this one that is not taken."""
    reach = 1
    while grid in taken:
        steps = random.integers(-reach, reach + 1, len(grid))
        grid = tuple(int(i) for i in np.clip(np.array(grid) + steps, 0, np.array(space.levels) - 1))
        reach += 1
    return grid


def grow(small: Path, big: Path, count: int) -> None:
    """A run whose rows have the numbers of a smaller one's, objectives and designs a little moved."""
    known, random, taken = load_run(small), np.random.default_rng(1), set[Grid]()
    with RunStore.read(small) as store:
        meta = store.meta
    rows = known.search_records
    with RunStore.create(big, meta) as store:
        session = store.start_session(known.sessions[-1]["provenance"])
        with store.transaction():
            for number in range(count):
                told = rows[number % len(rows)].evaluation
                grid = moved(rows[number % len(rows)].grid, known.space, taken, random)
                taken.add(grid)
                design = known.space.from_indices(grid).to_dict()
                factors = 1.0 + SHARE * random.standard_normal(len(told.objectives))
                values = {key: float(v * f) for (key, v), f in zip(told.objectives.items(), factors, strict=True)}
                store.enqueue([(number, number // 25, grid, design)], known.study["hash"])
                evaluation = dataclasses.replace(told, design=design, objectives=values)
                store.finish(Record(number, None, grid, "", evaluation))
        store.update_session(session, known.seconds, "budget used up")


def page(report: Path) -> None:
    """When the page shows its first content, when its charts stand, what its main thread worked by then."""
    from playwright.sync_api import sync_playwright

    flags = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=flags)
        shown = browser.new_page(viewport={"width": 1280, "height": 900})
        shown.set_default_timeout(300_000)
        tools = shown.context.new_cdp_session(shown)
        tools.send("Performance.enable", {"timeDomain": "threadTicks"})
        shown.add_init_script(LOOK)

        def until(said: str, condition: str, moment: Callable[[], float]) -> None:
            shown.wait_for_function(condition)
            metrics = {each["name"]: each["value"] for each in tools.send("Performance.getMetrics")["metrics"]}
            print(f"| {said} | {moment() / 1e3:.2f} | {metrics['TaskDuration']:.2f} |")

        print(f"{report.stat().st_size / 1e6:.1f} MB\n\n| | s | CPU s of the main thread |\n| --- | --- | --- |")
        shown.goto(report.resolve().as_uri(), wait_until="commit")
        paint = "performance.getEntriesByName('first-contentful-paint')"
        until("first content", f"{paint}.length", lambda: float(shown.evaluate(f"{paint}[0].startTime")))
        until("trade-offs drawn", "drawn.front", lambda: float(shown.evaluate("drawn.front")))
        for chart in ("what-if-chart", "progress"):
            begun = float(
                shown.evaluate(f"element('{chart}')?.scrollIntoView({{behavior: 'instant'}}), performance.now()")
            )
            drawn = f"drawn['{chart}']"
            wait = partial(lambda drawn, begun: max(0.0, float(shown.evaluate(drawn)) - begun), drawn, begun)
            until(f"{chart} drawn after scrolling to it", drawn, wait)
        for said, action in ACTIONS.items():
            timed = f"const t = performance.now(); {action}; document.body.offsetHeight; return performance.now() - t;"
            until(said, "true", partial(float, shown.evaluate(f"(() => {{ {timed} }})()")))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    jobs = parser.add_subparsers(dest="job", required=True)
    jobs.add_parser("run").add_argument("--evaluations", type=int, default=20_000)
    growing = jobs.add_parser("grow")
    growing.add_argument("small", type=Path)
    growing.add_argument("big", type=Path)
    growing.add_argument("--designs", type=int, default=10_000)
    jobs.add_parser("read").add_argument("run", type=Path)
    jobs.add_parser("page").add_argument("report", type=Path)
    given = parser.parse_args()
    os.environ["PYTHONPATH"] = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    if given.job == "run":
        run(given.evaluations)
    elif given.job == "read":
        read(given.run, READERS)
    elif given.job == "grow":
        grow(given.small, given.big, given.designs)
    else:
        page(given.report)


if __name__ == "__main__":
    main()
