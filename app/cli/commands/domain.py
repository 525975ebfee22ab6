"""`lissom domain`: picture → outline, cage and triangulation."""

import argparse

import numpy as np

from app.cli.console import notice
from app.document import Meshing
from app.reports import draw_preview
from app.storage import check_writable, open_picture, write_arrays, write_atomically
from engine.domain import texture_coordinates


def run(arguments: argparse.Namespace) -> int:
    """Build the domain of a picture and write it."""
    for path in (arguments.out, arguments.preview):
        if path is not None:
            check_writable(path)
    meshing = Meshing(triangles=arguments.triangles, detail=arguments.detail)
    opened = open_picture(arguments.picture, meshing)
    for message in opened.notices:
        notice(message)
    picture, domain = opened.picture, opened.document.figures[0].domain
    mesh = domain.mesh
    if arguments.preview is not None:
        drawn = draw_preview(picture, domain)
        write_atomically(arguments.preview, lambda file: file.write(drawn))
    write_arrays(
        arguments.out,
        {
            "outline": domain.outline,
            "cage": domain.cage,
            "vertices": mesh.vertices,
            "triangles": mesh.triangles,
            "uv": texture_coordinates(mesh.vertices, picture.size),
            "image_size": np.array(picture.size),
        },
    )
    print(
        f"{arguments.out}: {picture.size[0]} × {picture.size[1]} pixels, outline and cage of "
        f"{len(domain.cage)} vertices, {len(mesh.triangles):,} triangles"
    )
    return 0
