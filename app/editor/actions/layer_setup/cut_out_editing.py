"""Cutting the subject out of its picture by hand: colour, brush, knife, mask and holes."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from app.cut_out import CutLine, Mask
from app.document import shape_commands
from app.editor.action import do
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.error_reports import run_job
from app.editor.parts.tools import CutTool
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.storage import (
    check_writable,
    cut_picture,
    decode_mask,
    encode_mask,
    read_file,
    write_atomically,
)
from app.texts import _
from engine.domain import CUT_WIDTH
from engine.geometry import box_diagonal, distance_to_segments

WRITING = JobKind(_("Saving the mask"), _("The mask was not saved"))
MASKS = (".png",)
SMALLEST_BRUSH, LARGEST_BRUSH = 1.0, 1000.0  # pixels of the picture
BRUSH_STEP = 1.25
FIRST_BRUSH = 0.03  # of the picture's longer side
BESIDE = 1.25  # widths of a slit: a handle nearer to the knife's line may be inside the slit
DROP = 2  # radius in pixels around a picked place whose colours count


def toggle_cut_tool(session: Session, tool: CutTool | None) -> None:
    """Select a cut-out tool; None, or the selected tool again, selects the pose tool."""
    if session.tools.active_tool is None:
        session.tools.toggle(tool or "pose")
        if session.tools.is_cutting:
            playback.stop_playback(session)


@named_action(
    _("Cut out"),
    "X",
    icon="SCISSORS",
    hint=_("Cut the subject out of its picture: by colour, brush, knife or mask"),
    active=lambda session: session.tools.is_cutting,
)
def toggle_cut_brush(session: Session) -> None:
    """Select the brush that removes; if a brush is selected, swap keep and remove."""
    toggle_cut_tool(session, "keep" if session.tools.mode == "remove" else "remove")


UNLESS_BRUSH = unless(
    lambda session, _: session.tools.mode in {"keep", "remove", "stiff", "soft", "normal"},
    _("Select a brush first: Cut out, or Make parts stiff."),
)


@named_action(_("Larger brush"), "RightBracket", why_disabled=UNLESS_BRUSH, repeats_while_held=True)
@with_project
def enlarge_brush(session: Session, project: Project) -> None:
    set_brush_radius(session, brush_radius(project) * BRUSH_STEP)


@named_action(_("Smaller brush"), "LeftBracket", why_disabled=UNLESS_BRUSH, repeats_while_held=True)
@with_project
def shrink_brush(session: Session, project: Project) -> None:
    set_brush_radius(session, brush_radius(project) / BRUSH_STEP)


@with_project
def set_brush_radius(_: Session, project: Project, radius: float) -> None:
    """Set the radius of the brush, in pixels of the picture."""
    project.layer_setup.set_brush(min(max(radius, SMALLEST_BRUSH), LARGEST_BRUSH))


def brush_radius(project: Project) -> float:
    if project.layer_setup.brush is not None:
        return project.layer_setup.brush
    return max(4.0, FIRST_BRUSH * max(project.layer.picture.size))


@with_project
def change_cut_out(session: Session, project: Project, /, **changes: Any) -> None:
    cut_out = replace(project.layer.cut_out, **changes)
    editing.edit_layer(session, shape_commands.set_cut_out, cut_out)


def set_background_tolerance(session: Session, tolerance: int) -> None:
    """Set the number of levels by which the background may vary."""
    change_cut_out(session, tolerance=tolerance)


def set_background(session: Session, background: Any) -> None:
    """Set the removed background: "auto", "none", or a colour. A loaded mask is dropped."""
    change_cut_out(session, background=background, mask=None)


def set_enclosed_removed(session: Session, enclosed: Any) -> None:
    """Set whether enclosed areas of the background's colour are removed."""
    change_cut_out(session, enclosed=enclosed)


@with_project
def pick_background_colour(session: Session, project: Project, place: complex) -> None:
    """Use the picture's colour at a place as the background colour."""
    rgba = project.layer_runtime.picture.rgba
    height, width = rgba.shape[:2]
    point = place - project.layer.corner
    row, column = int(height - point.imag), int(point.real)
    if not (0 <= row < height and 0 <= column < width):
        return
    around = rgba[
        max(0, row - DROP) : row + DROP + 1, max(0, column - DROP) : column + DROP + 1, :3
    ]
    red, green, blue = (int(level) for level in np.median(around.reshape(-1, 3), axis=0))
    set_background(session, (red, green, blue))


@with_project
def cut_with_knife(session: Session, project: Project, slit: CutLine) -> None:
    """Cut along a line of the knife; the line may cross no handle."""
    layer = project.layer
    width = CUT_WIDTH * box_diagonal(layer.domain.outline)
    for handle in layer.handles:
        if _away_from(slit, handle.position - layer.corner) < BESIDE * width:
            session.notices.show(
                _(
                    "The knife line crosses {handle}. Draw the line beside the handle, or move "
                    "the handle."
                ).format(handle=handle.name),
                tone="error",
            )
            return
    editing.edit_layer(session, shape_commands.cut_with_line, slit)


@with_project
def remove_knife_cut(session: Session, project: Project, place: complex, reach: float) -> None:
    """Remove the knife line nearest to a place, at most `reach` away."""
    slits = project.layer.cut_out.cut_lines
    away = [_away_from(slit, place - project.layer.corner) for slit in slits]
    if min(away, default=np.inf) <= reach:
        nearest = away.index(min(away))
        change_cut_out(session, cut_lines=slits[:nearest] + slits[nearest + 1 :])


def _away_from(slit: CutLine, point: complex) -> float:
    """Return the distance of a point of the picture from a knife line."""
    return float(distance_to_segments(np.array([point]), slit.points[:-1], slit.points[1:]).min())


@with_project
def toggle_hole(session: Session, project: Project, place: complex) -> None:
    """Keep the hole at a place if it would be filled, or fill it if it would be kept."""
    holes, point = project.layer_runtime.cut.value.holes, place - project.layer.corner
    number = holes.number_at(point) if holes is not None else 0
    if holes is None or not number:
        return
    swapped = project.layer.cut_out.toggled_holes
    others = tuple(other for other in swapped if holes.number_at(other) != number)
    # The middle of the hole, since the click may have been at its rim.
    named = (*swapped, holes.middles[number])
    change_cut_out(session, toggled_holes=others if len(others) < len(swapped) else named)


def clear_cut_out_strokes(session: Session) -> None:
    """Delete all strokes, knife lines and the mask."""
    change_cut_out(session, strokes=(), cut_lines=(), mask=None)


def ask_mask_to_load(session: Session) -> None:
    session.ask_file(_("Load a mask"), MASKS, lambda path: do(load_mask, path))


@with_project
def load_mask(session: Session, project: Project, path: Path) -> None:
    """Read a mask on the worker; it replaces the background and all strokes."""
    identity = project.selection.active

    def take(mask: Mask) -> None:
        if session.project is project and project.selection.active == identity:
            change_cut_out(session, mask=mask, strokes=())

    kind = JobKind(_("Loading the mask"), _("{name} cannot be loaded").format(name=path.name))
    run_job(session, kind, lambda: decode_mask(read_file(path), path.name), take)


@with_project
def ask_mask_to_save(session: Session, project: Project) -> None:
    name = _("{project} mask").format(project=project.file.name) + MASKS[0]
    session.ask_file(_("Save the mask"), MASKS, lambda path: do(save_mask, path), name=name)


@with_project
def save_mask(session: Session, project: Project, path: Path) -> None:
    """Save the kept area as a black and white picture."""
    picture, cut_out = project.layer_runtime.picture, project.layer.cut_out
    check_writable(path, sources=project.file.sources)

    def work() -> None:
        content = encode_mask(Mask.of(cut_picture(picture, cut_out).kept))
        write_atomically(path, lambda file: file.write(content))

    text = _("Saved {name}.").format(name=path.name)
    run_job(session, WRITING, work, lambda _result: session.notices.show(text, tone="good"))
