"""Reloading the changed file of a project's drawing."""

from contextlib import ExitStack
from pathlib import Path

from app.cli.console import StatusLine, print_line, print_notices
from app.document import Document
from app.errors import LissomError, join_names
from app.solving import (
    Change,
    ReloadPlan,
    find_drawing,
    plan_reload,
    reload_lines,
    start_reload,
    step_reload,
)
from app.storage import (
    FileLock,
    FileLockedError,
    Picture,
    check_writable,
    cut_picture,
    decode_pictures,
    draw_thumbnail,
    flatten_layers,
    load_project,
    read_drawing,
    save_project,
)
from app.texts import _, message_of


def reload_project(project: Path, new: Path, out: Path | None, layer: str | None) -> None:
    """Reload a project's drawing from a changed file, print the changes, and write the project.

    A project that a window has open is not overwritten.
    """
    target = project if out is None else out
    check_writable(target, sources=[new] if out is None else [new, project])
    with ExitStack() as ending:
        try:
            ending.callback(FileLock(target).release)
        except FileLockedError as error:
            text = _("{path} is open {where}; reload the drawing there, or give --out")
            raise LissomError(text.format(path=target, where=message_of(error))) from error
        except OSError:
            pass  # a disk without locks
        _reload(project, new, target, layer)


def _reload(project: Path, new: Path, target: Path, layer: str | None) -> None:
    document = load_project(project)
    drawing = find_drawing(document, new.name)
    changed = read_drawing(new, is_merged=drawing.is_merged)
    print_notices(changed.summary.lines)
    pictures = _pictures(document, project)
    only = None if layer is None else [_layer_id(document, layer)]
    plan = plan_reload(document, drawing, changed, pictures, only=only)
    for line in reload_lines(plan):
        print_line(line)
    if plan.is_empty and target == project:
        print_line(_("{path}: nothing changed").format(path=target))
        return
    with StatusLine() as status:
        reloading = start_reload(plan)
        while not reloading.is_over:
            status.show(_("solving keys: {share:.0%}").format(share=reloading.progress))
            reloading = step_reload(reloading)
    print_notices(reloading.all_notices)
    after = reloading.command(document)
    known = {file.sha256: picture for file, picture in reloading.pictures.items()}
    known |= {each.picture.sha256: pictures[each.id] for each in document.layers}
    textures = {
        each.id: cut_picture(known[each.picture.sha256], each.cut_out).texture
        for each in after.layers
    }
    save_project(target, after, thumbnail=draw_thumbnail(flatten_layers(after, textures)))
    print_line(_summary(target, plan))


def _pictures(document: Document, project: Path) -> dict[int, Picture]:
    files = list(dict.fromkeys(layer.picture for layer in document.layers))
    title = _("the picture of {project}").format(project=project)
    decoded = decode_pictures([(file.data, title) for file in files])
    by_file = dict(zip(files, decoded, strict=True))
    return {layer.id: by_file[layer.picture] for layer in document.layers}


def _layer_id(document: Document, name: str) -> int:
    for layer in document.layers:
        if layer.name == name:
            return layer.id
    names = join_names([layer.name for layer in document.layers])
    raise LissomError(
        _("there is no layer {name!r}; choose from: {names}").format(name=name, names=names)
    )


def _summary(path: Path, plan: ReloadPlan) -> str:
    redrawn = plan.count(Change.REDRAWN, Change.REDRAWN_AND_MOVED)
    text = _("{path}: {redrawn} redrawn, {moved} moved, {new} new, {gone} gone, {same} same")
    return text.format(
        path=path,
        redrawn=redrawn,
        moved=plan.count(Change.MOVED),
        new=plan.count(Change.NEW),
        gone=plan.count(Change.GONE),
        same=plan.count(Change.SAME),
    )
