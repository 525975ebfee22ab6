"""`lissom pose`: picture + pose script → project."""

import argparse

from app.cli.console import StatusLine, notice
from app.document import Meshing
from app.solving import load_pose_script, pose_document
from app.storage import check_writable, draw_thumbnail, open_picture, save_project


def run(arguments: argparse.Namespace) -> int:
    """Solve the keys of a script and write the project."""
    check_writable(arguments.out)
    script = load_pose_script(arguments.script)
    meshing = Meshing(triangles=arguments.triangles, detail=arguments.detail)
    opened = open_picture(arguments.picture, meshing)
    for message in opened.notices:
        notice(message)
    status = StatusLine()
    document, lags = pose_document(opened.document, script, status.show)
    status.clear()
    for message in lags:
        notice(message)
    save_project(arguments.out, document, thumbnail=draw_thumbnail(opened.picture.rgba))
    figure = document.figures[-1]
    print(f"{arguments.out}: {len(figure.keys)} keys, {len(figure.handles)} handles")
    return 0
