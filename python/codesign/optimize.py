"""A study's optimisation: the search asks, executors evaluate, the store keeps, in an order that decides nothing."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Literal

from codesign.cache import SqliteCache, default_cache_path
from codesign.design import DesignSpace
from codesign.errors import StudyError
from codesign.evolution import ALGORITHMS, Evolution, EvolutionSettings
from codesign.execute import DEFAULT_LOADER, Executor, Limits, LocalPool, StudyRef
from codesign.loop import Loop, Schedule, Stop
from codesign.progress import Progress
from codesign.runs import Run, load_run
from codesign.search import Grid, Listed, RandomSearch, Search, start_points, sub_grid
from codesign.store import RunStore
from codesign.worker import load

Cache = Path | str | None | Literal["default"]


@dataclass(frozen=True, slots=True)
class Settings:
    """Everything that decides which designs a run evaluates; kept in its store, so that resume needs nothing else.

    steady: no barrier between generations: an offspring is made as soon as fewer than `lag` designs are unranked.
    evaluations: the whole budget, start population included.
    """

    algorithm: str = "nsga2"
    population: int = 25
    evaluations: int | None = 1000
    crossover_probability: float = 0.9
    mutation_probability: float = 0.25
    seed: int = 1
    start: str = "sobol"
    first: tuple[Grid, ...] = ()
    steady: bool = False
    lag: int | None = None
    wall_time: float | None = None
    stall_generations: int | None = None
    stall_tolerance: float = 1e-3
    listed: tuple[Grid, ...] = ()

    def __post_init__(self) -> None:
        if self.population < 2:
            raise ValueError(f"population = {self.population}: at least 2 is needed")
        for name in ("evaluations", "lag", "wall_time", "stall_generations"):
            value = getattr(self, name)
            if value is not None and value <= 0:
                raise ValueError(f"{name} = {value}: must be above 0")
        for name in ("crossover_probability", "mutation_probability"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise ValueError(f"{name} = {getattr(self, name)}: must be in 0 … 1")

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> Settings:
        """Inverse of `dataclasses.asdict` after JSON."""
        lists = {name: tuple(tuple(grid) for grid in document[name]) for name in ("first", "listed")}
        return cls(**(dict(document) | lists))

    def search(self, space: DesignSpace, objectives: Sequence[str]) -> Search:
        """The search that these settings describe."""
        if self.algorithm == "listed":
            return Listed(self.listed)
        if self.algorithm == "random":
            return RandomSearch(space, self.seed)
        evolution = EvolutionSettings(
            self.algorithm, self.population, self.crossover_probability, self.mutation_probability, self.seed
        )
        first = list(dict.fromkeys(self.first))
        start = [*first, *(g for g in start_points(space, self.population, self.start, self.seed) if g not in first)]
        return Evolution(space, objectives, evolution, start[: max(self.population, len(first))])

    def schedule(self) -> Schedule:
        """When to ask."""
        if self.algorithm in ALGORITHMS:
            window = self.lag or self.population
            return Schedule(self.population, 1, window) if self.steady else Schedule(self.population)
        return Schedule(self.population, self.population, max(4096, self.population))

    def stop(self) -> Stop:
        """When to end."""
        return Stop(self.evaluations, self.wall_time, self.stall_generations, self.stall_tolerance)


def optimize(
    study: Any,
    *,
    out: str | Path,
    population: int | None = None,
    generations: int | None = None,
    evaluations: int | None = None,
    seed: int = 1,
    algorithm: str = "nsga2",
    workers: int | None = None,
    cluster: str | None = None,
    start: str = "sobol",
    first: Sequence[Mapping[str, float]] = (),
    steady: bool = False,
    lag: int | None = None,
    wall_time: float | None = None,
    stall_generations: int | None = None,
    cache: Cache = "default",
    progress: Callable[[Progress], None] | None = None,
) -> Run:
    """Searches the study's design grid for the best compromises and keeps every evaluation in folder `out`.

    Args:
        study: a loaded study, or a shipped study's name or the path of a study file.
        out: folder of the run; must not hold one yet.
        population, generations: as in the study's [optimizer] unless given; the budget is their product.
        evaluations: the budget itself, instead of generations.
        seed: decides everything that is random.
        algorithm: nsga2, nsga3, agemoea, agemoea2, smsemoa, or random (random search).
        workers: worker processes here; None: as in the study's [execution].
        cluster: a Dask scheduler's address (tcp://host:port), or local:N for N Dask workers here, instead of `workers`.
        start: start population: sobol (scrambled by the seed), sobol-plain (as in the paper) or random.
        first: designs to evaluate at the head of the start population.
        steady: offspring without waiting for whole generations; `lag` designs unranked at most (default: population).
        wall_time: seconds after which no new design is asked for.
        stall_generations: ends when the hypervolume has grown by less than 0.1 % over so many generations.
        cache: file of the cache of parts and designs; "default": one for all runs of the study; None: no cache.
        progress: called with the state after every change.

    Returns: the finished run.
    Raises: StoreError (folder holds a run, is being written, disk full), ExecutionError (workers do not start),
        ValueError (wrong settings), KeyboardInterrupt (Ctrl-C: nothing stored is lost, `resume` continues).
    """
    study = _loaded(study)
    optimizer = study.optimizer
    size = population or int(optimizer.population)
    settings = Settings(
        algorithm=algorithm,
        population=size,
        evaluations=evaluations or size * (generations or int(optimizer.generations)),
        crossover_probability=float(optimizer.crossover_probability),
        mutation_probability=float(optimizer.mutation_probability),
        seed=seed,
        start=start,
        first=tuple(study.space.indices(design) for design in first),
        steady=steady,
        lag=lag,
        wall_time=wall_time,
        stall_generations=stall_generations,
    )
    return run_search(study, settings, out, workers=workers, cluster=cluster, cache=cache, progress=progress)


def sweep(
    study: Any,
    counts: Sequence[int],
    *,
    out: str | Path,
    workers: int | None = None,
    cluster: str | None = None,
    cache: Cache = "default",
    progress: Callable[[Progress], None] | None = None,
) -> Run:
    """Evaluates every design of a sub-grid with `counts[i]` evenly spread values of variable i."""
    study = _loaded(study)
    settings = Settings(algorithm="listed", listed=tuple(sub_grid(study.space, counts)), evaluations=None)
    return run_search(study, settings, out, workers=workers, cluster=cluster, cache=cache, progress=progress)


def evaluate_designs(
    study: Any,
    designs: Sequence[Mapping[str, float]],
    *,
    out: str | Path,
    workers: int | None = None,
    cluster: str | None = None,
    cache: Cache = "default",
    progress: Callable[[Progress], None] | None = None,
) -> Run:
    """Evaluates the given designs, kept and resumable like any run."""
    study = _loaded(study)
    grids = tuple(dict.fromkeys(study.space.indices(design) for design in designs))
    settings = Settings(algorithm="listed", listed=grids, evaluations=None)
    return run_search(study, settings, out, workers=workers, cluster=cluster, cache=cache, progress=progress)


def run_search(
    study: Any,
    settings: Settings,
    out: str | Path,
    *,
    workers: int | None = None,
    cluster: str | None = None,
    cache: Cache = "default",
    progress: Callable[[Progress], None] | None = None,
) -> Run:
    """A new run of the search that `settings` describe."""
    settings.search(study.space, study.objectives)  # refuses wrong settings before anything is written
    ref = StudyRef.of(study)
    meta = {
        "study": {"name": study.name, "source": ref.source, "loader": ref.loader, "hash": ref.hash},
        "variables": [asdict(variable) for variable in study.space.variables],
        "objectives": list(study.objectives),
        "settings": asdict(settings),
        "cache": str(cache) if cache is not None else None,
    }
    with RunStore.create(out, meta) as store:
        _drive(study, settings, store, workers, cluster, cache, progress)
    return load_run(out)


def resume(
    out: str | Path,
    *,
    study: Any = None,
    workers: int | None = None,
    cluster: str | None = None,
    evaluations: int | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Run:
    """Continues a run: repeats its search over the stored rows, then goes on as if it had never stopped.

    Args:
        study: the study, if it cannot be loaded from where the run found it.
        evaluations: a larger budget than the run had.

    Raises: StoreError (no run, being written), StudyError (the study's results would be others than the stored ones).
    """
    with RunStore.open(out) as store:
        known = store.meta["study"]
        study = study if study is not None else load(known["loader"], known["source"])
        if study.hash != known["hash"]:
            raise StudyError(
                f"{known['source']}: the study, or the program, has changed since {out} was started, so its rows would "
                "not be comparable: start a new run (its cache keeps what is unchanged)"
            )
        settings = Settings.from_document(store.meta["settings"])
        if evaluations is not None:
            settings = replace(settings, evaluations=evaluations)
            store.set_meta("settings", asdict(settings))
        cache = store.meta["cache"]
        _drive(study, settings, store, workers, cluster, cache, progress)
    return load_run(out)


def _drive(
    study: Any,
    settings: Settings,
    store: RunStore,
    workers: int | None,
    cluster: str | None,
    cache: Cache,
    progress: Callable[[Progress], None] | None,
) -> None:
    path = default_cache_path(study.name) if cache == "default" else cache
    designs = SqliteCache(path) if path is not None else None
    search = settings.search(study.space, study.objectives)
    total = settings.evaluations or len(settings.listed)
    size = math.prod(study.space.levels)

    def executor() -> Executor:
        return _executor(study, workers, cluster, path)

    try:
        loop = Loop(study, search, settings.schedule(), settings.stop(), store, designs, progress, min(total, size))
        loop.run(executor)
    finally:
        if designs is not None:
            designs.close()


def _executor(study: Any, workers: int | None, cluster: str | None, cache: Path | str | None) -> Executor:
    execution = study.execution
    limits = Limits(float(execution.time_limit_s or 0), int(execution.memory_limit_mib or 0))
    if cluster is not None:
        from codesign.cluster import DaskExecutor

        return DaskExecutor(StudyRef.of(study), cluster, limits, cache)
    return LocalPool(StudyRef.of(study), workers or int(execution.workers), limits, cache)


def _loaded(study: Any) -> Any:
    if isinstance(study, str | Path):
        return load(DEFAULT_LOADER, str(study))
    return study
