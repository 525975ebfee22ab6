"""`lissom domain`: picture → outline, cage and triangulation."""

import argparse

import numpy as np

from app.cli.console import notice
from app.cli.cut_out import read_cut_out
from app.cli.hole_arrays import hole_arrays
from app.reports import draw_preview
from app.storage import (
    check_writable,
    decode_picture,
    read_picture_file,
    write_arrays,
    write_atomically,
)
from engine.domain import build_domain, texture_coordinates


def run(arguments: argparse.Namespace) -> int:
    """Build the domain of a picture and write it."""
    for path in (arguments.out, arguments.preview):
        if path is not None:
            check_writable(path)
    picture = decode_picture(read_picture_file(arguments.picture), str(arguments.picture))
    domain, remedies = build_domain(
        picture.rgba,
        triangles=arguments.triangles,
        detail=arguments.detail,
        cut_out=read_cut_out(arguments),
    )
    for message in (*picture.notices, *remedies):
        notice(message)
    mesh, holes = domain.mesh, domain.holes
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
            **hole_arrays(holes),
            "uv": texture_coordinates(mesh.vertices, picture.size),
            "image_size": np.array(picture.size),
        },
    )
    kept = f", {len(holes)} {'hole' if len(holes) == 1 else 'holes'}" if holes else ""
    print(
        f"{arguments.out}: {picture.size[0]} × {picture.size[1]} pixels, outline and cage of "
        f"{sum(map(len, domain.cages))} vertices{kept}, {len(mesh.triangles):,} triangles"
    )
    return 0
