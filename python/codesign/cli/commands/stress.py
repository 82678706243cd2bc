"""Commands about any part: stress, materials."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from codesign.cli.console import print_json
from codesign.cli.options import JsonOption

commands = typer.Typer()
LOADS = (
    "Total force FX FY FZ or bearing FX FY FZ (a pin in a bore) in N, moment MX MY MZ in N m, "
    "pressure P or traction TX TY TZ in MPa."
)
ExclusionOption = Annotated[
    float | None,
    typer.Option(
        metavar="MM",
        help="Ignore stress peaks within this distance of borders of clamps; default: a fifth of the wall, hole, "
        "fillet or clamp there.",
    ),
]
RepairOption = Annotated[
    bool,
    typer.Option("--repair", help="Make one solid of a file with doubled or turned facets, gaps, overlapping bodies."),
]


@commands.command(
    epilog="Example: `codesign stress part.stl --scale 1e-3 --fix near:0,0,0 --load 'normal:0,0,1: 0 0 -250'`"
)
def stress(
    part: Annotated[Path, typer.Argument(metavar="PART", help="Closed surface: STL, binary or ASCII, or a STEP file.")],
    fix: Annotated[list[str], typer.Option(metavar="SEL", help="Held in all directions, or 'SEL: xz' in two.")],
    load: Annotated[
        list[str] | None,
        typer.Option(metavar="'SEL: LOAD'", help=LOADS),
    ] = None,
    acceleration: Annotated[
        str | None, typer.Option(metavar="'AX AY AZ'", help="Of the whole part, as gravity: m/s².")
    ] = None,
    scale: Annotated[float, typer.Option(help="Meters per unit of an STL file and of the selections.")] = 1e-3,
    material: Annotated[
        str, typer.Option(help="A name that `codesign materials` lists, or E_GPa,nu,yield_MPa[,kg/m3].")
    ] = "ergal",
    edge_length: Annotated[
        float | None, typer.Option(metavar="MM", help="Edge length of the elements; default: from the wall thickness.")
    ] = None,
    vtu: Annotated[Path | None, typer.Option(help="Where to write displacement and stress, for ParaView.")] = None,
    png: Annotated[Path | None, typer.Option(help="Where to write a picture of the stressed part.")] = None,
    exclusion: ExclusionOption = None,
    smooth: Annotated[
        bool, typer.Option("--smooth", help="The file is a coarse tessellation of curved faces: curve its facets back.")
    ] = False,
    repair: RepairOption = False,
    no_simplify: Annotated[
        bool, typer.Option("--no-simplify", help="Keep edges that are tiny (0.05 mm) beside the elements.")
    ] = False,
    as_json: JsonOption = False,
) -> int:
    """Safety factor of any closed surface; exit code 1 if the material yields.

    SEL is near:x,y,z (the smooth face nearest to a point), box:x0,y0,z0,x1,y1,z1 (all faces inside) or
    normal:nx,ny,nz[:degrees] (faces that look there), face:NAME (of a STEP file, or its number), hole:r=RADIUS (all
    round holes of that radius, no fillets); in the file's units. `codesign faces` lists those of a STEP file.
    """
    from codesign.cli.stress import stress_document
    from codesign.cli.stress_options import find_material
    from codesign.cli.stress_text import print_stress

    document = stress_document(
        part,
        scale,
        find_material(material),
        fix,
        load or [],
        edge_length,
        vtu,
        png,
        exclusion,
        smooth,
        repair,
        not no_simplify,
        acceleration,
    )
    if as_json:
        print_json(document)
    else:
        print_stress(document)
    factor = document["safety_factor"]
    return 0 if factor is None or factor >= 1.0 else 1


@commands.command(epilog="Example: `codesign faces bracket.step`")
def faces(
    part: Annotated[Path, typer.Argument(metavar="PART", help="A STEP file of one solid.")],
    as_json: JsonOption = False,
) -> int:
    """Faces of a STEP file for the selections of `codesign stress`: name or number, type, radius, area, middle."""
    from codesign.cli.stress_file import face_documents, print_faces

    documents = face_documents(part)
    if as_json:
        print_json(documents)
    else:
        print_faces(documents)
    return 0


@commands.command(epilog="Example: `codesign materials ti-6al-4v`")
def materials(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="Everything known of one.")] = None,
    as_json: JsonOption = False,
) -> int:
    """Materials that a study and `codesign stress` know by name: stiffness, strength, density, cost, source."""
    from codesign.cli.materials import material_documents, print_materials

    if as_json:
        print_json(material_documents(name))
    else:
        print_materials(name)
    return 0
