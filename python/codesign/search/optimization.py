"""A study's optimization: start a search, continue it; sweeps and lists of designs by the same means."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, TypedDict, Unpack

from codesign.errors import ExecutionError, StudyError
from codesign.execution.pool import DEFAULT_LOADER, Executor, Limits, LocalPool, StudyRef
from codesign.execution.worker import load
from codesign.problem.design_space import DesignValue
from codesign.problem.identity import Identity
from codesign.problem.protocols import OptimizerDefaults, Problem
from codesign.search.driver import SearchDriver
from codesign.search.progress import Progress
from codesign.search.provenance import check_search, search_identity
from codesign.search.registry import find_search
from codesign.search.sampling import sub_grid
from codesign.search.settings import Settings
from codesign.storage.cache import default_cache_path, open_cache
from codesign.storage.runs import Run, load_run
from codesign.storage.store import RunStore

StudyLike = Problem | str | Path


class Resources(TypedDict, total=False):
    """Where evaluations run, and who is told; decides nothing about the results.

    workers: worker processes here; None or left out: as in the study's [execution].
    cluster: a Dask scheduler's address (tcp://host:port), or local:N for N Dask workers here, instead of `workers`.
    cache: file of the cache of parts and designs; None: no cache; left out: the one of all runs of the study.
    progress: called with the state after every change.
    limits: of an evaluation; None or left out: those of the study's [execution].
    """

    workers: int | None
    cluster: str | None
    cache: Path | str | None
    progress: Callable[[Progress], None] | None
    limits: Limits | None


def optimize(
    study: StudyLike,
    *,
    out: str | Path,
    population: int | None = None,
    generations: int | None = None,
    evaluations: int | None = None,
    seed: int | None = None,
    algorithm: str | None = None,
    start: str = "sobol",
    first: Sequence[Mapping[str, DesignValue]] = (),
    steady: bool = False,
    lag: int | None = None,
    lazy: bool | None = None,
    wall_time: float | None = None,
    stall_generations: int | None = None,
    options: Mapping[str, Any] | None = None,
    **resources: Unpack[Resources],
) -> Run:
    """Searches the study's design grid for the best compromises and keeps every evaluation in folder `out`.

    Args:
        study: a loaded study, or a shipped study's name or the path of a study file.
        out: folder of the run; must not hold one yet.
        population, generations, seed: as in the study's [optimizer] unless given; the seed decides what is random.
        evaluations: the budget itself, instead of population times generations.
        algorithm: the study's unless given: surrogate, nsga2, nsga3, agemoea, agemoea2, smsemoa, random; a name in an
            installed package's entry points `codesign.searches`; or `module:attribute`, a `SearchKind`.
        start: start population: sobol (scrambled by the seed), sobol-plain (as in the paper) or random.
        first: designs to evaluate at the head of the start population.
        steady: offspring without waiting for whole generations; `lag` designs unranked at most (default: population).
        lazy: strength and clearances only of designs that can enter the front; None: the study's, or the search's.
        wall_time: seconds after which no new design is asked for.
        stall_generations: ends when the hypervolume has grown by less than 0.1 % over so many generations.
        options: of the algorithm itself, JSON values.
        resources: see Resources.

    Returns: the finished run.
    Raises: StoreError (folder holds a run, is being written, disk full), ExecutionError (workers do not start),
        ValueError (wrong settings), KeyboardInterrupt (Ctrl-C: nothing stored is lost, `resume` continues).
    """
    study = _able_to_fly(load_problem(study))
    size = study.optimizer.population if population is None else population
    algorithm = _own_algorithm(study) if algorithm is None else algorithm
    settings = Settings(
        algorithm=algorithm,
        population=size,
        evaluations=_budget(study, algorithm, size, generations) if evaluations is None else evaluations,
        seed=study.optimizer.seed if seed is None else seed,
        start=start,
        first=tuple(study.space.indices(design) for design in first),
        steady=steady,
        lag=lag,
        lazy=_lazily(study, algorithm) if lazy is None else lazy,
        wall_time=wall_time,
        stall_generations=stall_generations,
        options=dict(options or {}),
        **_breeding(study.optimizer),
    )
    return run_search(study, settings, out, **resources)


def _able_to_fly(study: Problem) -> Problem:
    if why := getattr(study, "grounded", None):
        raise StudyError(f"{study.source}: {why}; `codesign check` tells more")
    return study


def _own_algorithm(study: Problem) -> str:
    name = study.optimizer.algorithm
    try:
        find_search(name)
    except ValueError as error:
        raise StudyError(f"{study.source}: optimizer.{error}") from error
    return name


def _budget(study: Problem, algorithm: str, population: int, generations: int | None) -> int:
    """Evaluations where no number is given: asked generations, the study's number, the search's own, the study's ones.

    Raises: ValueError: there is no such search.
    """
    if generations is not None:
        return population * generations
    if study.optimizer.evaluations is not None:
        return study.optimizer.evaluations
    return find_search(algorithm).evaluations or population * study.optimizer.generations


def _breeding(optimizer: OptimizerDefaults) -> dict[str, Any]:
    names = ("crossover_probability", "mutation_probability")
    return {name: getattr(optimizer, name) for name in names}


def _lazily(study: Problem, algorithm: str) -> bool:
    """What the study says, else what the search prefers. Raises: ValueError: there is no such search."""
    said = study.execution.lazy
    return find_search(algorithm).lazy if said is None else bool(said)


def sweep(study: StudyLike, counts: Sequence[int], *, out: str | Path, **resources: Unpack[Resources]) -> Run:
    """Evaluates every design of a sub-grid with `counts[i]` evenly spread values of variable i."""
    study = load_problem(study)
    return run_search(study, Settings.listing(sub_grid(study.space, counts)), out, **resources)


def evaluate_designs(
    study: StudyLike, designs: Sequence[Mapping[str, DesignValue]], *, out: str | Path, **resources: Unpack[Resources]
) -> Run:
    """Evaluates the given designs, each once, kept and resumable like any run."""
    study = load_problem(study)
    grids = [study.space.indices(design) for design in designs]
    return run_search(study, Settings.listing(grids), out, **resources)


def run_search(study: Problem, settings: Settings, out: str | Path, **resources: Unpack[Resources]) -> Run:
    """A new run of the search that `settings` describe; arguments and errors as in `optimize`."""
    settings.plan(study.space, study.objectives)  # refuses wrong settings before anything is written
    ref = StudyRef.of(study)
    cache = cache_path(study, resources)
    meta = {
        "study": {
            "name": study.name,
            "source": ref.source,
            "loader": ref.loader,
            "hash": ref.hash,
            "identity": ref.identity.document(),
        },
        "search": search_identity(settings.algorithm).document(),
        "variables": [asdict(variable) for variable in study.space.variables],
        "objectives": list(study.objectives),
        "settings": settings.document(),
        "cache": None if cache is None else str(cache),
    }
    with RunStore.create(out, meta) as store:
        try:
            _drive(study, settings, store, cache, resources)
        except (ExecutionError, ValueError):
            if store.counts().keys() <= {"queued"}:  # the workers did not even start
                store.discard()
            raise
    return load_run(out)


def resume(
    out: str | Path,
    *,
    study: Problem | None = None,
    evaluations: int | None = None,
    wall_time: float | None = None,
    **resources: Unpack[Resources],
) -> Run:
    """Continues a run: repeats its search over the stored rows, then goes on as if it had never stopped.

    A run whose wall time is used up goes on without a limit of it, unless another is given.

    Args:
        study: the study, if it cannot be loaded from where the run found it.
        evaluations: a larger budget than the run had.
        wall_time: seconds from now after which no new design is asked for.
        resources: see Resources; the cache is the run's unless given.

    Raises: StoreError (no run, being written), StudyError (the study's results would be others than the stored ones);
        else as `optimize`.
    """
    with RunStore.open(out) as store:
        study = stored_study(store, study)
        settings = Settings.from_document(store.meta["settings"])
        check_search(store.meta.get("search"), settings.algorithm, store.path.parent)
        if evaluations is not None:
            settings = replace(settings, evaluations=evaluations)
        spent = sum(session["seconds"] for session in store.sessions())
        if wall_time is not None:
            settings = replace(settings, wall_time=spent + wall_time)
        elif settings.wall_time is not None and spent >= settings.wall_time:
            settings = replace(settings, wall_time=None)
        store.set_meta("settings", settings.document())
        _drive(study, settings, store, resources.get("cache", store.meta["cache"]), resources)
    return load_run(out)


def load_problem(study: StudyLike) -> Problem:
    """The study itself, or loaded from its name or path."""
    return load(DEFAULT_LOADER, str(study)) if isinstance(study, str | Path) else study


def stored_study(store: RunStore, study: Problem | None = None) -> Problem:
    """The study of a run, loaded from where the run found it unless given; refused if it is no longer the same."""
    known = store.meta["study"]
    if study is None:
        study = load(known["loader"], known["source"])
    if study.hash != known["hash"]:
        raise StudyError(
            f"{known['source']}: the study, or the program, has changed since {store.path.parent} was started "
            f"({Identity.from_document(known.get('identity')).differences(study.identity)}), so new rows would not be "
            "comparable with its own: start a new run (the cache keeps what is unchanged), or undo the change"
        )
    return study


def cache_path(study: Problem, resources: Resources) -> Path | str | None:
    """The cache file that the arguments ask for."""
    return resources.get("cache", default_cache_path(study.name))


def make_executor(study: Problem, resources: Resources, cache: Path | str | None, tasks: int) -> Executor:
    """Local workers (no more than there are tasks) or a Dask cluster, as the arguments ask for."""
    execution = study.execution
    limits = resources.get("limits") or Limits(execution.time_limit_s, execution.memory_limit_mib)
    cluster = resources.get("cluster")
    if cluster is not None:
        from codesign.execution.cluster import DaskExecutor

        return DaskExecutor(StudyRef.of(study), cluster, limits, cache)
    workers = resources.get("workers")
    count = execution.workers if workers is None else workers
    if count < 1:
        raise ValueError(f"workers = {count}: at least 1 is needed")
    return LocalPool(StudyRef.of(study), min(count, tasks), limits, cache)


def _drive(study: Problem, settings: Settings, store: RunStore, cache: Path | str | None, resources: Resources) -> None:
    plan = settings.plan(study.space, study.objectives)
    with open_cache(cache, study.identity.program) as designs:
        driver = SearchDriver(study, plan, store, designs, resources.get("progress"))
        driver.run(lambda: make_executor(study, resources, cache, plan.total))
