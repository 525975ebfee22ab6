"""`lissom export`: a project's animation as pictures."""

import argparse
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from app.cli.console import StatusLine, notice
from app.document import ExportSettings, FrameRange, clip_of
from app.export import (
    ExportPlan,
    ExportRequest,
    KeptPoses,
    Painter,
    check_request,
    export,
    plan_export,
    sheet_grid,
)
from app.export_formats import EXPORT_FORMATS, format_by_suffix
from app.motion import Animation
from app.render.gpu import create_context
from app.storage import decode_picture, load_project


def run(arguments: argparse.Namespace) -> int:
    """Export a project."""
    document = load_project(arguments.project)
    request = ExportRequest(
        out=arguments.out, settings=_settings(document.export, arguments), fps=arguments.fps
    )
    check_request(document, request)
    pictures = {
        figure.id: decode_picture(figure.picture.data, f"the picture of {arguments.project}").rgba
        for figure in document.figures
    }
    context = create_context()
    status = StatusLine()
    try:
        status.show("preparing the in-betweens")
        poses = {
            figure.id: KeptPoses(Animation(clip_of(document, figure.id), arguments.variant))
            for figure in document.figures
        }
        plan = plan_export(document, request, poses)
        painter = Painter(context, document, pictures, poses, plan)
        with closing(export(plan, painter.pose, painter.draw)) as steps:
            for done in steps:
                status.show(f"{done} of {len(plan.times)} frames")
    finally:
        status.clear()
        context.release()
    for message in (*painter.notices, *plan.notices):
        notice(message)
    print(_summary(plan))
    return 0


def _settings(own: ExportSettings, arguments: argparse.Namespace) -> ExportSettings:
    """Return the project's settings with those that were given in their place."""
    given = {
        "format": arguments.format or _format_of(arguments.out),
        "size": arguments.size,
        "background": arguments.background,
        "framing": arguments.framing,
        "frames": None if arguments.frames is None else FrameRange(*arguments.frames),
    }
    return replace(own, **{name: value for name, value in given.items() if value is not None})


def _format_of(out: Path) -> str | None:
    """Return the one format that a name stands for."""
    return None if out.is_dir() else format_by_suffix().get(out.suffix.lower())


def _summary(plan: ExportPlan) -> str:
    width, height = plan.view.size
    count = len(plan.times)
    text = f"{plan.out}: {count} {'frame' if count == 1 else 'frames'} of {width} × {height} pixels"
    if not EXPORT_FORMATS[plan.format].suffixes:
        names = dict.fromkeys((plan.names[0], plan.names[-1]))
        return f"{text}, {' to '.join(names)}"
    if plan.format == "spritesheet":
        columns, rows = sheet_grid(plan)
        return f"{text} in {columns} columns and {rows} rows"
    return f"{text}, {plan.fps:g} a second"
