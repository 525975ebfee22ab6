"""`lissom export`: a project's animation as pictures, video or a model."""

import argparse
from collections.abc import Mapping
from contextlib import ExitStack, closing
from dataclasses import replace
from pathlib import Path
from typing import Any

from app.cli.console import StatusLine, print_line, print_notices
from app.document import (
    Document,
    ExportSettings,
    FrameRange,
    clip_of,
    motion_notices,
    without_foreign_clips,
)
from app.errors import LissomError, join_names
from app.export import (
    PROJECT,
    CachedVertices,
    ExportPlan,
    ExportRequest,
    FrameRenderer,
    MeshExport,
    check_request,
    data_file,
    plan_export,
    sheet_grid,
    with_reduced_meshes,
)
from app.export_formats import EXPORT_FORMATS, STILL_FORMAT, FormatSettings, format_by_suffix
from app.motion import Animation, placed_animations
from app.render.gpu.context import create_context
from app.storage import cut_picture, decode_picture, load_project
from engine.arrays import Bytes

NO_USE = "{name} has no use for --{flag}; leave it out"


def run(arguments: argparse.Namespace) -> int:
    document = load_project(arguments.project)
    print_notices(motion_notices(document))
    if arguments.layer is not None:
        document = _alone(document, arguments.layer)
    name = arguments.project.stem
    named: Path = arguments.out.path
    out = named.parent / named.name.replace(PROJECT, name)
    request = ExportRequest(
        out=out,
        settings=_settings(document.export, arguments, out),
        project=name,
        fps=arguments.fps,
        sources=(arguments.project,),
    )
    if EXPORT_FORMATS[request.settings.format].suffixes:
        arguments.out.as_file()
    check_request(document, request)
    _check_options(request.settings.format, arguments)
    source = f"the picture of {arguments.project}"
    decoded = {
        file: decode_picture(file.data, source)
        for file in {layer.picture for layer in document.layers}
    }
    pictures = {
        layer.id: cut_picture(decoded[layer.picture], layer.cut_out).texture
        for layer in document.layers
    }
    print_line(_make(document, pictures, request, arguments))
    return 0


def _alone(document: Document, name: str) -> Document:
    """Return a document with only one visible layer; its parent stays."""
    names = [layer.name for layer in document.layers]
    if name not in names:
        raise LissomError(f"there is no layer {name!r}; the layers are {join_names(names)}")
    layers = tuple(
        replace(layer, hidden=False, reference=layer.name != name) for layer in document.layers
    )
    groups = tuple(replace(group, hidden=False) for group in document.groups)
    alone = replace(document, layers=layers, groups=groups, size=document.canvas)
    return without_foreign_clips(alone, [layer.id for layer in layers if layer.name == name])


def _make(
    document: Document,
    pictures: Mapping[int, Bytes],
    request: ExportRequest,
    arguments: argparse.Namespace,
) -> str:
    """Run the export; return a summary."""
    maker: FrameRenderer | MeshExport
    with ExitStack() as ending:
        context = None
        if EXPORT_FORMATS[request.settings.format].is_drawn:
            context = create_context()
            ending.callback(context.release)
        else:
            document = with_reduced_meshes(document, request.settings.shapes.triangles)
        status = ending.enter_context(StatusLine())
        status.show("preparing the in-betweens")
        poses = _poses(document, arguments)
        plan = plan_export(document, request, poses)
        given = document, pictures, poses, plan
        maker = MeshExport(*given) if context is None else FrameRenderer(context, *given)
        with closing(maker.run()) as steps:
            for done in steps:
                status.show(f"{done} of {len(plan.times)} frames")
    print_notices((*maker.notices, *plan.notices))
    if isinstance(maker, MeshExport):
        return _summary_of_shapes(maker, plan)
    return _summary_of_frames(plan)


def _poses(document: Document, arguments: argparse.Namespace) -> dict[int, CachedVertices]:
    alone = [Animation(clip_of(document, layer.id), arguments.variant) for layer in document.layers]
    hung = placed_animations(alone, document)
    return {layer: CachedVertices(animation) for layer, animation in hung.items()}


def _settings(own: ExportSettings, arguments: argparse.Namespace, out: Path) -> ExportSettings:
    """Return the project's settings, replaced by the given options."""
    one = arguments.frame
    frames = arguments.frames if one is None else (one, one)
    name = arguments.format or _format_of(out, own, is_one=one is not None)
    own = own if name is None else own.in_format(name)
    given = {
        "size": arguments.size,
        "background": arguments.background,
        "framing": arguments.framing,
        "frames": None if frames is None else FrameRange(*frames),
        "names": arguments.names,
    }
    options = {
        group: replace(
            asking, **_known({name: getattr(arguments, name) for name in asking.option_fields()})
        )
        for group, asking in own.options().items()
    }
    return replace(own, **_known(given), **options)


def _check_options(name: str, arguments: argparse.Namespace) -> None:
    """Raise `LissomError` for options that the format does not use."""
    format_ = EXPORT_FORMATS[name]
    framing = () if format_.has_frame else ("size", "background", "framing")
    useless = {option: option for option in (*framing, *(("names",) if format_.suffixes else ()))}
    for group, asking in FormatSettings().options().items():
        if group != format_.options:
            useless |= {each: option.flag for each, option in asking.option_fields().items()}
    for each, flag in useless.items():
        if getattr(arguments, each) is not None:
            raise LissomError(NO_USE.format(name=name, flag=flag))


def _known(given: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in given.items() if value is not None}


def _format_of(out: Path, own: ExportSettings, *, is_one: bool) -> str | None:
    """Return the only format for a file name, or None if the project's format fits.

    For a single frame, pictures come first among several formats.

    Raises `LissomError` if no format or several formats have this suffix.
    """
    suffix = out.suffix.lower()
    if out.is_dir() or not suffix:
        return None
    every = {end: name for name, format_ in EXPORT_FORMATS.items() for end in format_.suffixes}
    if suffix not in every:
        raise LissomError(
            f"no format has names that end in {out.suffix}: choose one of {', '.join(every)}, or "
            "say --format"
        )
    is_own = suffix in EXPORT_FORMATS[own.format].suffixes
    if suffix in format_by_suffix() or (is_own and not is_one):
        return None if is_own else format_by_suffix()[suffix]
    several = [name for name, format_ in EXPORT_FORMATS.items() if suffix in format_.suffixes]
    if is_one:
        return STILL_FORMAT
    raise LissomError(
        f"{out} may be {' or '.join(several)}: say --format, or --frame N for the picture of a "
        "frame"
    )


def _summary_of_frames(plan: ExportPlan) -> str:
    width, height = plan.view.size
    count = len(plan.times)
    text = f"{plan.out}: {count} {'frame' if count == 1 else 'frames'} of {width} × {height} pixels"
    if not EXPORT_FORMATS[plan.format].suffixes:
        names = dict.fromkeys((plan.names[0], plan.names[-1]))
        return f"{text}, {' to '.join(names)}"
    data = data_file(plan.out, plan.format)
    if data is not None:
        columns, rows = sheet_grid(plan)
        grid = f" in {columns} columns and {rows} rows"
        return f"{text}{', trimmed' if plan.sheet.trimmed else grid}, as {data.name} tells"
    return f"{text}, {plan.fps:g} a second"


def _summary_of_shapes(maker: MeshExport, plan: ExportPlan) -> str:
    first, last = plan.span
    counts = [
        f"{len(shape.motion.targets)} shapes of {len(shape.uv):,} vertices within "
        f"{shape.motion.error:.2g} pixels of the motion"
        for shape in maker.meshes
    ]
    size = plan.out.stat().st_size / 1000
    seconds = (last - first) / plan.fps
    return f"{plan.out}: {'; '.join(counts)}, {seconds:g} s, {size:,.0f} KB"
