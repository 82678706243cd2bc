"""All files of one design: for the workshop (STL, STEP), for simulators (URDF), for the analyst (VTU, JSON)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

import meshio
import numpy as np

from codesign import fem
from codesign.chain.chain import build_parts, build_robot, evaluate_with_fields
from codesign.files import write_text
from codesign.parts.cad_export import export_parts
from codesign.parts.component import Component
from codesign.parts.part import Part
from codesign.problem.design_space import Design
from codesign.robot.package import write_urdf_package

if TYPE_CHECKING:
    from codesign.chain.study import Study


def export_design(study: Study, theta: Mapping[str, float], out: str | Path) -> list[Path]:
    """Evaluates a design and writes its files into a folder (made if absent); returns their paths.

    `evaluation.json`: all numbers. `cad/`: STL and STEP of each part and its mirror image, 3MF; GLB and STEP assembly
    of all of them in their places on the robot. `robot/`: URDF with meshes. `stress/`: VTU of each part.
    Raises: DesignError, CodesignError of the chain.
    """
    out = Path(out)
    design = study.space.design(theta)
    parts = build_parts(study, design)
    components = placed_components(study, design, parts)
    out.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(1) as beside:  # the native chain releases the interpreter's lock
        chain = beside.submit(evaluate_with_fields, study, design)
        drawn = export_parts([component for component, _ in components], out / "cad")
        drawn.append(_write_robot(study, design, components, out / "robot"))
        evaluation, analyses, _ = chain.result()
    files = [write_text(out / "evaluation.json", json.dumps(evaluation.to_dict(), indent=1)), *drawn]
    fields = [write_vtu(a.mesh, a.result, out / "stress" / f"{name}.vtu") for name, a in analyses.items()]
    return files + fields


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


def _write_robot(study: Study, design: Design, components: list[tuple[Component, str]], folder: Path) -> Path:
    robot = build_robot(study, design)
    placements = {place.link: place for part in study.config.parts for place in part.placements}
    writers = {}
    for component, link in components:
        filename = f"{component.part.name}.stl"
        writers[filename] = component.part.write_stl
        robot = robot.set_mesh(link, filename, placements[link].link_T_part.matrix(), 1e-3)
    return write_urdf_package(robot, folder, writers)


def write_vtu(mesh: fem.TetMesh, result: fem.StaticResult, path: Path) -> Path:
    """Writes the fields of an analysis for ParaView.

    At the nodes displacement [m], stress [Pa; xx yy zz xy yz zx] and von Mises stress [Pa]; of each element `error`,
    how far its own stress is from the recovered one [Pa].
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    field = meshio.Mesh(
        np.array(mesh.nodes),
        [("tetra10", np.array(mesh.tets))],
        point_data={
            "displacement": np.array(result.displacement),
            "stress": np.array(result.stress),
            "von_mises": np.array(result.von_mises),
        },
        cell_data={"error": [np.array(result.element_error)]},
    )
    temporary = path.with_name(f".{path.name}.tmp.vtu")
    try:
        meshio.write(temporary, field, file_format="vtu")
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
    return path
