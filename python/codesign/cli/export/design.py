"""All files of one design: for the workshop (STL, STEP), for simulators (URDF), for the analyst (VTU, JSON)."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from codesign import _core, fem
from codesign.chain.chain import build_parts, build_robot, evaluate_with_fields, fly_design, stress_settings
from codesign.cli.export.folder import MANIFEST, export_folder, files_in
from codesign.cli.export.formats import CAD, DEFAULT, LOG, ROBOT
from codesign.cli.export.order import Order
from codesign.cli.export.page import OrderPage
from codesign.cli.export.robot_files import AS_FLOWN, write_robot_files, write_urdf
from codesign.errors import DesignError
from codesign.fem.gmsh import write_msh
from codesign.fem.vtu import StressModel, write_vtu
from codesign.files import write_text
from codesign.interrupts import native_threads
from codesign.parts.cad_export import export_parts
from codesign.parts.component import Component
from codesign.parts.load_case import part_case
from codesign.parts.part import Part
from codesign.problem.design_space import Design, DesignValue, value_text
from codesign.report.study_words import part_words
from codesign.report.verdict import Judge, Verdict, run_verdict, study_verdict
from codesign.storage.cache import default_cache_path, open_cache
from codesign.storage.designs import keep_evaluation, known_evaluation

if TYPE_CHECKING:
    from codesign.chain.study import Study
    from codesign.dynamics import FlightLog
    from codesign.problem.evaluation import Evaluation
    from codesign.robot.formats.simplified import Simplification


def export_design(
    study: Study,
    theta: Mapping[str, DesignValue],
    out: str | Path,
    *,
    run: ChosenDesign | None = None,
    organization: str = "",
    force: bool = False,
    formats: Sequence[str] = DEFAULT,
    robot_files: Simplification = AS_FLOWN,
) -> list[Path]:
    """Evaluates a design and writes its files into a folder (made if absent); returns their paths.

    `README.md`, `manifest.json`, `bom.csv`: what it is, of what, how many, in which units. `evaluation.json`: all
    numbers. `cad/`: STL and STEP of each part and its mirror image, 3MF of all pieces side by side; GLB and STEP
    assembly of all of them in their places on the robot. `robot/`: URDF with meshes; MJCF, SDF and the history of the
    flight if asked for. `stress/`: VTU of each part.

    run: the design as one of a run, for where it comes from and the run's verdict on it; None: its values were given.
    organization: for the files' headers. force: replace another design's export. formats: which of `formats.FORMATS`
    are written. robot_files: what is written differently from the robot that was flown.

    Raises: DesignError; ExportError if the folder holds something else; CodesignError of the chain.
    """
    out = Path(out)
    design = study.space.design(theta)
    parts = build_parts(study, design)
    placed = placed_components(study, design, parts)
    components = [component for component, _ in placed] + unplaced(study, parts)
    order = Order(study, design, components, run.words if run is not None else "", organization, formats)
    with export_folder(out, order.revision, force) as folder:
        with native_threads(1) as beside:  # the native chain releases the interpreter's lock
            chain = beside.submit(_computed, study, design, formats)
            _write_cad(order, folder / "cad")
            evaluation, analyses, flight = chain.result()
        if flight is not None and any(kind in formats for kind in (*ROBOT, *LOG)):
            write_robot_files(study, evaluation, placed, flight, formats, folder / "robot", robot_files)
        elif study.config.robot is not None and "urdf" in formats:
            write_urdf(study, build_robot(study, design), placed, folder / "robot")
        models = {}
        if "vtu" in formats:
            models = {
                name: _write_stress(order, name, parts[name], analysis, folder / "stress")
                for name, analysis in analyses.items()
            }
        if "msh" in formats:
            _write_meshes(analyses, folder / "stress")
        write_text(folder / "evaluation.json", json.dumps(evaluation.to_dict(), indent=1))
        write_text(folder / "bom.csv", order.bill_of_materials())
        verdict = run.judge(evaluation) if run is not None else study_verdict(study, evaluation)
        page = OrderPage(order, evaluation, verdict, models, run.confirmed if run is not None else {})
        write_text(folder / "README.md", page.text(_written(folder)))
        files = [*_written(folder), MANIFEST]
        write_text(folder / MANIFEST, page.manifest(files))
    return [out / file for file in sorted(files)]


def _written(folder: Path) -> list[str]:
    """Files in a folder, relative to it."""
    return [path.relative_to(folder).as_posix() for path in files_in(folder)]


def _computed(
    study: Study, design: Design, formats: Sequence[str]
) -> tuple[Evaluation, dict[str, _core.PartAnalysis], FlightLog | None]:
    """What the files are made of. Fields are computed for `vtu` and `msh` only: known numbers come from the cache."""
    grid = study.space.indices(design)
    with open_cache(default_cache_path(study.name), study.identity.program) as cache:
        known = None if {"vtu", "msh"} & set(formats) else known_evaluation(study, grid, cache)
        if known is not None:
            wanted = any(kind in formats for kind in (*ROBOT, *LOG))
            return known, {}, fly_design(study, design) if wanted else None
        evaluation, analyses, flight = evaluate_with_fields(study, design)
        keep_evaluation(study, grid, evaluation, cache)
        return evaluation, analyses, flight


@dataclass(frozen=True, slots=True)
class ChosenDesign:
    """A design of a run.

    words: where it comes from, "design 14 of runs/a". judge: the run's verdict on it. confirmed: its parts on finer
    meshes, if the run has them.
    """

    study: Study
    design: dict[str, DesignValue]
    words: str
    judge: Judge
    confirmed: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)


def design_of_run(run_directory: Path, selector: str) -> ChosenDesign:
    """A design of a run: `recommended` or a number. Raises: StoreError, StudyError, DesignError."""
    from codesign.followup.validation import select
    from codesign.report.reading import read_report_data, study_of

    study = study_of(run_directory)
    if study is None:
        raise DesignError(f"{run_directory}: the run's study cannot be loaded any more")
    run = read_report_data(run_directory, study)
    found = select(run, [selector])
    if len(found) != 1:
        raise DesignError(f"--design {selector}: one design is needed, recommended or a number")
    ((role, design),) = found.items()
    position = next(i for i, entry in enumerate(run.entries) if entry.evaluation.design == design)
    words = f"design {run.entries[position].id} of {run_directory.name}"
    words += "" if role.startswith("design") else f" ({role})"
    known = run.confirmed.get(tuple(design.values()))

    def judge(evaluation: Evaluation) -> Verdict:
        return run_verdict(run, position, evaluation)

    return ChosenDesign(study, design, words, judge, known.parts if known is not None else {})


def placed_components(study: Study, design: Design, parts: Mapping[str, Part]) -> list[tuple[Component, str]]:
    """Every part in its places on the robot, all joints at zero, and the link that it is."""
    poses = build_robot(study, design).frame_poses()
    components = []
    for config in study.config.parts:
        for place in config.placements:
            part = parts[config.name]
            if place.mirror is not None:
                part = part.mirrored(place.mirror, f"{config.name}_mirrored")
            pose = poses[place.link] @ place.link_T_part.matrix()
            components.append((Component(place.link, part, pose), place.link))
    return components


def unplaced(study: Study, parts: Mapping[str, Part]) -> list[Component]:
    """One piece, at the origin, of every part that has no place on the robot."""
    names = [section.name for section in study.config.parts if not section.placements]
    return [Component(name, parts[name], np.eye(4)) for name in names]


def _write_cad(order: Order, folder: Path) -> None:
    wanted = [kind for kind in CAD if kind in order.formats]
    if wanted:
        organization = order.organization or order.study.title
        export_parts(
            order.components,
            folder,
            revision=order.revision,
            organization=organization,
            formats=wanted,
            captions=order.captions() if {"pdf", "dxf"} & set(wanted) else None,
        )


def _write_stress(order: Order, name: str, part: Part, analysis: _core.PartAnalysis, folder: Path) -> str:
    """VTU of a part's analysis, and of the whole part where one half was analyzed; returns what the model is in words.

    The file names say it too: NAME_simplified_half.vtu, NAME_simplified_whole.vtu.
    """
    config = order.study.configured(order.design)
    settings = stress_settings(config, name)
    case = part_case(part, settings)
    planes = _symmetry_planes(analysis.mesh, case.supports)
    simplified = settings.geometry == "simplified" and part.fem_shape("simplified") != part.fem_shape("full")
    kind = "simplified" if simplified else "full"
    words = f"{kind} geometry" + (f", 1/{2 ** len(planes)} of the symmetric part" if planes else ", whole part")
    stem = f"{name}_simplified" if simplified else name
    result = analysis.result
    notes = {
        "part": part.title,
        "model": words,
        "load_case": part_words(config)[name].load,
        "material": settings.material.name,
        "result": f"safety factor {result.safety_factor:.6g}, peak stress {result.peak_stress:.6g} Pa where "
        "counts_for_peak is 1",
        "design": ", ".join(f"{key} = {value_text(value)}" for key, value in order.design.items()),
        "revision": order.revision,
    }
    model = StressModel.of(analysis.mesh, result)
    write_vtu(model, folder / (f"{stem}_half.vtu" if planes else f"{stem}.vtu"), notes)
    if planes:
        for point, normal in planes:
            model = model.with_mirror_image(point, normal, case.cases[analysis.governing].antisymmetric)
        write_vtu(model, folder / f"{stem}_whole.vtu", notes | {"model": f"{words}, and its mirror image"})
    return words


def _write_meshes(analyses: Mapping[str, _core.PartAnalysis], folder: Path) -> None:
    """The analyzed mesh of each part for Gmsh."""
    folder.mkdir(exist_ok=True)
    for name, analysis in analyses.items():
        write_msh(analysis.mesh, folder / f"{name}.msh", name)


def _symmetry_planes(mesh: fem.TetMesh, supports: list[_core.fem.Support]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Point and unit normal of every plane that cuts the model off from its mirror image."""
    planes = []
    for support in supports:
        if support.symmetry:
            faces = [mesh.face_names.index(face) for face in support.where.faces]
            nodes = mesh.nodes[np.unique(mesh.boundary[np.isin(mesh.boundary_face, faces)])]
            point = nodes.mean(axis=0)
            planes.append((point, np.linalg.svd(nodes - point, full_matrices=False)[2][2]))
    return planes
