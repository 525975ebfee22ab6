"""A project's animation as pictures, video or a model."""

from contextlib import ExitStack, closing
from dataclasses import replace

from app.cli.console import StatusLine, print_notices
from app.document import Document, Variant, without_foreign_clips
from app.errors import LissomError, join_names
from app.export import (
    ExportPlan,
    ExportRequest,
    FrameRenderer,
    MeshExport,
    data_file,
    plan_export,
    sheet_grid,
    with_reduced_meshes,
)
from app.export_formats import EXPORT_FORMATS
from app.motion import Evaluator
from app.render.gpu.context import create_context
from app.storage import cut_picture, decode_picture
from app.texts import _, ngettext
from engine.arrays import Bytes


def keep_layer(document: Document, name: str) -> Document:
    """Return a document with only one visible layer; its parent stays."""
    names = [layer.name for layer in document.layers]
    if name not in names:
        raise LissomError(
            _("there is no layer {name!r}; choose from: {names}").format(
                name=name, names=join_names(names)
            )
        )
    layers = tuple(
        replace(layer, hidden=False, reference=layer.name != name) for layer in document.layers
    )
    groups = tuple(replace(group, hidden=False) for group in document.groups)
    shown = replace(document, layers=layers, groups=groups, size=document.canvas)
    return without_foreign_clips(shown, [layer.id for layer in layers if layer.name == name])


def export_project(document: Document, request: ExportRequest, variant: Variant | None) -> str:
    """Run the export; return a summary."""
    source = _("the picture of {project}").format(project=request.sources[0])
    pictures = _pictures(document, source)
    if variant is not None:
        layers = tuple(replace(layer, variant=variant) for layer in document.layers)
        document = replace(document, layers=layers)
    maker: FrameRenderer | MeshExport
    with ExitStack() as ending:
        context = None
        if EXPORT_FORMATS[request.settings.format].is_drawn:
            context = create_context()
            ending.callback(context.release)
        else:
            document = with_reduced_meshes(document, request.settings.shapes.triangles)
        status = ending.enter_context(StatusLine())
        status.show(_("preparing the in-betweens"))
        evaluator = Evaluator.exact(document)
        plan = plan_export(document, request, evaluator)
        given = document, pictures, evaluator, plan
        maker = MeshExport(*given) if context is None else FrameRenderer(context, *given)
        with closing(maker.run()) as steps:
            for done in steps:
                text = ngettext(
                    "{done} of {count} frame", "{done} of {count} frames", len(plan.times)
                ).format(done=done, count=len(plan.times))
                status.show(text)
    print_notices((*maker.notices, *plan.notices))
    if isinstance(maker, MeshExport):
        return _summary_of_shapes(maker, plan)
    return _summary_of_frames(plan)


def _pictures(document: Document, source: str) -> dict[int, Bytes]:
    """Return the cut-out pictures by layer; layers may share a file."""
    decoded = {
        file: decode_picture(file.data, source)
        for file in {layer.picture for layer in document.layers}
    }
    return {
        layer.id: cut_picture(decoded[layer.picture], layer.cut_out).texture
        for layer in document.layers
    }


def _summary_of_frames(plan: ExportPlan) -> str:
    width, height = plan.size
    count = len(plan.times)
    values = {"path": plan.out, "count": count, "width": width, "height": height}
    if EXPORT_FORMATS[plan.format].is_still:
        return _("{path}: {width} × {height} pixels").format(**values)
    if not EXPORT_FORMATS[plan.format].suffixes:
        text = ngettext(
            "{path}: {count} frame of {width} × {height} pixels, {first}",
            "{path}: {count} frames of {width} × {height} pixels, {first} to {last}",
            count,
        )
        return text.format(**values, first=plan.names[0], last=plan.names[-1])
    data = data_file(plan.out, plan.format)
    if data is None:
        text = ngettext(
            "{path}: {count} frame of {width} × {height} pixels, {fps:g} a second",
            "{path}: {count} frames of {width} × {height} pixels, {fps:g} a second",
            count,
        )
        return text.format(**values, fps=plan.fps)
    if plan.sheet.trimmed:
        text = ngettext(
            "{path}: {count} frame of {width} × {height} pixels, trimmed, listed in {data}",
            "{path}: {count} frames of {width} × {height} pixels, trimmed, listed in {data}",
            count,
        )
    else:
        columns, rows = sheet_grid(plan)
        values |= {"columns": columns, "rows": rows}
        text = ngettext(
            "{path}: {count} frame of {width} × {height} pixels in {columns} columns and {rows} "
            "rows, listed in {data}",
            "{path}: {count} frames of {width} × {height} pixels in {columns} columns and {rows} "
            "rows, listed in {data}",
            count,
        )
    return text.format(**values, data=data.name)


def _summary_of_shapes(maker: MeshExport, plan: ExportPlan) -> str:
    first, last = plan.span
    count = sum(len(shape.motion.targets) for shape in maker.meshes)
    text = ngettext(
        "{path}: {count} shape of {vertices:,} vertices within {error:.2g} pixels of the motion; "
        "{seconds:g} s, {size:,.0f} KB",
        "{path}: {count} shapes of {vertices:,} vertices within {error:.2g} pixels of the motion; "
        "{seconds:g} s, {size:,.0f} KB",
        count,
    )
    return text.format(
        path=plan.out,
        count=count,
        vertices=sum(len(shape.uv) for shape in maker.meshes),
        error=max(shape.motion.error for shape in maker.meshes),
        seconds=round((last - first) / plan.timeline_fps, 2),
        size=plan.out.stat().st_size / 1000,
    )
