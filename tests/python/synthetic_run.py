"""A made-up run: smooth objectives near the shipped study's values, lost flights, broken parts, failed meshes."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from codesign.chain.study import load_study
from codesign.execution.pool import StudyRef
from codesign.problem.design_space import DesignSpace, Variable
from codesign.problem.evaluation import Evaluation
from codesign.problem.identity import Identity
from codesign.storage.records import Record
from codesign.storage.store import RunStore

SPACE = DesignSpace(
    (
        Variable("angle", 1, 79, 1, "deg"),
        Variable("distance", 40, 100, 2, "mm"),
        Variable("offset", 80, 120, 2, "mm"),
        Variable("length", 50, 150, 2, "mm"),
    )
)
BASELINE = {"angle": 15, "distance": 42, "offset": 80, "length": 108}


def objectives(angle: float, distance: float, offset: float, length: float) -> dict[str, float]:
    """Smooth stand-ins with a conflict between momentum and joint velocity."""
    momentum = 1.553 + 0.0095 * angle + 6e-6 * angle**3 + 4.5e-4 * (length - 50) + 2.5e-5 * (distance - 50) ** 2
    velocity = 0.2637 - 6.5e-5 * (length - 50) + 2.2e-4 * angle + 2.5e-6 * (offset - 98) ** 2
    thrust = 655.9 + 0.012 * (angle - 1) ** 2 + 0.37 * (angle - 1) + 0.022 * (length - 50) + 0.05 * (distance - 40)
    return {"momentum": momentum, "joint_velocity": velocity, "thrust": thrust}


def part(mass: float, safety_factor: float) -> dict[str, object]:
    """Part numbers as an evaluation keeps them."""
    return {
        "mass": mass,
        "com": [0.04, 0.0, -0.0136],
        "inertia": np.diag([6.8e-5, 2.2e-4, 2.6e-4]).tolist(),
        "safety_factor": safety_factor,
        "peak_stress": 462e6 / safety_factor,
        "stress_50": 0.8 * 462e6 / safety_factor,
        "stress_error": 0.02 * 462e6 / safety_factor,
        "max_displacement": 2.1e-5,
        "work": 0.0026,
        "nodes": 21833,
        "tetrahedra": 13120,
        "seconds": {"mesh": 0.31, "solve": 0.28},
    }


def evaluate(design: dict[str, float]) -> Evaluation:
    """A made-up evaluation of a design."""
    angle, distance, offset, length = (design[v.name] for v in SPACE.variables)
    provenance = {"version": "0.1.0", "study_hash": "5f2c9e77aa10", "commit": "d4f7a00"}
    key = int(7 * angle + 13 * distance + 17 * offset + 29 * length)
    if key % 97 == 0:
        return Evaluation.failure(
            design, "MeshError: jetpack_bracket: volume of the mesh is 1.8 % off the surface's", provenance
        )
    if key % 211 == 0:
        return Evaluation.failure(design, "time limit: no answer within 60 s, worker stopped", provenance)
    bracket, forearm = 90.0 - angle - 0.35 * (distance - 40), 24.0 - 0.055 * (length - 50) - 0.12 * (offset - 80)
    parts = {
        "jetpack_bracket": part((43586.36 + 900 * distance) * 2.8e-6, bracket),
        "forearm_support": part(0.42 + 0.0023 * offset + 0.0011 * length, forearm),
    }
    seconds = {"geometry": 0.05, "fem": 1.4, "flight": 0.24, "total": 1.72}
    if angle > 34:
        lost = {"trajectory": "envelope", "duration": 120.0 / angle, "seconds": 0.03}
        return Evaluation(
            design,
            "infeasible",
            f"flight lost at {120.0 / angle:.2f} s: attitude error above 90°",
            parts=parts,
            flight=lost,
            seconds=seconds,
            provenance=provenance,
            constraints={"safety_factor": min(bracket, forearm)},
            violations={"flight": 1.0 - 120.0 / angle / 42.0, "safety_factor": 0.0},
        )
    values = objectives(angle, distance, offset, length)
    factor = min(bracket, forearm)
    violation = max(0.0, 1.0 - factor / 15.0)
    flight = {
        "trajectory": "envelope",
        "duration": 42.0,
        "max_com_error": 0.151,
        "max_attitude_error": 0.0593,
        "min_thrust": 101.0,
        "max_thrust": 223.0 + 0.5 * angle,
        "seconds": 0.24,
    }
    return Evaluation(
        design,
        "infeasible" if violation > 0 else "feasible",
        f"safety_factor {factor:.1f} below 15" if violation > 0 else None,
        objectives=values,
        objective_families={"rms": values, "script": {k: 70 * v for k, v in values.items()}, "paper": values},
        constraints={"safety_factor": factor, "flight_missed_share": 0.0},
        violations={"safety_factor": violation, "flight_missed_share": 0.0},
        parts=parts,
        flight=flight,
        seconds=seconds,
        provenance=provenance,
    )


def evaluations(count: int, seed: int = 1, steepest: int = 79) -> list[Evaluation]:
    """`count` different designs: half spread over the grid, half crowding towards the best, as a search would."""
    random = np.random.default_rng(seed)
    seen: dict[tuple[int, ...], None] = {}
    levels = np.array(SPACE.levels)
    while len(seen) < count:
        pull = (len(seen) / count) ** 0.7
        center = np.array([0, random.integers(0, 8), random.integers(2, 14), random.integers(0, 51)])
        anywhere = random.integers(0, levels)
        index = np.rint((1 - pull) * anywhere + pull * center + random.normal(0, 1.0, 4)).astype(int)
        index = np.clip(index, 0, levels - 1)
        if SPACE.variables[0].value(int(index[0])) <= steepest:
            seen[tuple(int(i) for i in index)] = None
    return [evaluate(SPACE.from_indices(index).to_dict()) for index in seen]


class Study:
    """The shipped study, but for evaluations, which are made up."""

    name, title, hash = "synthetic", "Jet interfaces of a flying robot", "5f2c9e77aa10"
    description = "Two parts carry the jets of a flying humanoid. Four numbers shape them."
    space, baseline = SPACE, SPACE.design(BASELINE)
    objectives = ("momentum", "joint_velocity", "thrust")
    identity = Identity({"study file": "5f2c9e77aa10"})

    def __getattr__(self, name: str) -> Any:
        return getattr(load_study("ironcub_paper"), name)

    def evaluate(self, design: Any) -> Evaluation:
        """The made-up evaluation."""
        return evaluate(dict(design))


def write_run(
    folder: Path, finished: list[Evaluation], *, planned: int | None = None, ended: bool = True, study: Any = None
) -> Path:
    """A run's store holding `finished` evaluations of `planned`; study: whose run it says to be."""
    ref = StudyRef.of(study) if study is not None else StudyRef("synthetic", Study.hash, identity=Study.identity)
    settings = {"algorithm": "nsga2", "seed": 1, "population": 25, "evaluations": planned or len(finished)}
    meta = {
        "study": {"name": "synthetic", "source": ref.source, "loader": ref.loader, "hash": ref.hash},
        "variables": [asdict(variable) for variable in SPACE.variables],
        "objectives": list(Study.objectives),
        "settings": settings,
        "cache": None,
    }
    with RunStore.create(folder, meta) as store:
        session = store.start_session(
            {"host": "here", "machine": "Linux", "processors": 2, "python": "3.11", "packages": {"numpy": "2"}}
        )
        grids = [SPACE.indices(evaluation.design) for evaluation in finished]
        store.enqueue(
            [(k, k // 25, g, e.design) for k, (g, e) in enumerate(zip(grids, finished, strict=True))], ref.hash
        )
        with store.transaction():
            for k, (grid, evaluation) in enumerate(zip(grids, finished, strict=True)):
                store.finish(Record(k, k // 25, grid, "", evaluation))
        if ended:
            store.update_session(session, 480.0, "generations done")
    return folder
