"""The handles: their names, weights and wishes."""

import math
from dataclasses import replace

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from app.actions import editing, posing
from app.actions.action import Action, do
from app.document import handle_commands
from app.document.keyframe import Handle
from app.session import Project, Session
from app.ui.theme import Look
from app.ui.widgets import heading, label, small

ROWS = 9.0  # em of the list


def draw(session: Session, look: Look) -> list[Action]:
    """Draw the list of handles and the one that is selected."""
    project = session.project
    if project is None or project.shown is None:
        return []
    document = project.document
    if not document.handles:
        small(look, "There are no handles yet. Click on the drawing to add one.")
        return []
    actions = _list(look, project)
    if len(project.selected) > 1:
        heading(look, f"{len(project.selected)} handles")
        small(look, "Dragging one moves them all. Arrows nudge them.")
        return actions + _delete(project.selected)
    chosen = next((h for h in document.handles if h.id in project.selected), None)
    if chosen is None:
        small(look, "Select a handle to see its settings.")
        return actions
    return actions + _details(look, project, chosen) + _delete(frozenset({chosen.id}))


def _list(look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    height = min(ROWS, 0.8 + 1.75 * len(project.document.handles)) * look.em
    imgui.begin_child("handles", ImVec2(0, height), imgui.ChildFlags_.borders)
    for handle in project.document.handles:
        is_anchor = handle.position == project.document.anchor
        icon = icons.ICON_FA_ANCHOR if is_anchor else icons.ICON_FA_CIRCLE_DOT
        clicked, _ = imgui.selectable(
            f"{icon}  {handle.name}###{handle.id}", handle.id in project.selected
        )
        if clicked:
            chosen = frozenset({handle.id})
            keeps = imgui.get_io().key_shift or imgui.get_io().key_ctrl
            actions.append(do(editing.select, project.selected ^ chosen if keeps else chosen))
    imgui.end_child()
    return actions


def _details(look: Look, project: Project, handle: Handle) -> list[Action]:
    actions: list[Action] = []
    heading(look, handle.name)
    label(look, "Name")
    entered, name = imgui.input_text(
        "##name", handle.name, imgui.InputTextFlags_.enter_returns_true
    )
    if entered and name.strip():
        actions.append(do(editing.edit, handle_commands.rename_handle(handle.id, name.strip())))
    label(look, "Weight")
    changed, weight = imgui.slider_float(
        "##weight", handle.weight, 0.01, 100.0, "%.2f", imgui.SliderFlags_.logarithmic
    )
    if changed:
        actions.append(do(editing.edit, handle_commands.weigh_handle(handle.id, weight)))
    actions += _wish(look, project, handle)
    imgui.dummy(ImVec2(0, 0.2 * look.em))
    is_anchor = handle.position == project.document.anchor
    changed, _ = imgui.checkbox("Anchor of the in-betweens", is_anchor)
    if changed:
        actions.append(do(posing.anchor_at, handle.id))
    return actions


def _wish(look: Look, project: Project, handle: Handle) -> list[Action]:
    actions: list[Action] = []
    pose = project.shown.pose if project.shown else None
    if pose is None or handle.id not in pose.targets:
        small(look, "Between keys a handle follows the shape. Drag it to make a key here.")
        return actions
    target = pose.targets[handle.id]
    label(look, "Place")
    place = [target.position.real, target.position.imag]
    changed, place = imgui.drag_float2("##place", place, 0.5, 0.0, 0.0, "%.1f")
    if changed:
        moved = replace(target, position=complex(*place))
        actions.append(do(posing.wish, {handle.id: moved}))
    label(look, "Turn")
    degrees = 0.0 if target.rotation is None else math.degrees(target.rotation)
    wording = "free" if target.rotation is None else "%.0f°"
    changed, degrees = imgui.drag_float("##turn", degrees, 0.5, -720.0, 720.0, wording)
    if changed:
        turned = replace(target, rotation=math.radians(degrees))
        actions.append(do(posing.wish, {handle.id: turned}))
    if target.rotation is not None and imgui.small_button("Let it turn freely"):
        actions.append(do(posing.free_turn, handle.id))
    lag = project.document.lags(pose).get(handle.id, 0.0)
    if lag > 1.0:
        imgui.text_colored(look.palette.warning, f"{lag:.1f} px short of its place")
    return actions


def _delete(handles: frozenset[int]) -> list[Action]:
    if imgui.button(f"{icons.ICON_FA_TRASH}  Delete"):
        return [do(posing.remove_handles, handles)]
    return []
