"""The layers of the scene: which there are, what is in front, what hangs on what."""

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from app.document import Figure, is_visible
from app.editor import Action, Project, Session, do, layering
from app.editor.actions import playback
from app.ui.style import (
    FILL,
    Look,
    Scale,
    heading,
    icon_button,
    label,
    shortened,
    slider,
    small,
    tip,
)

PERCENT = Scale(left=0, right=100)
MOVED = "layer"  # what is dragged from row to row
NOTHING = "nothing"


def draw(session: Session, look: Look) -> list[Action]:
    """Draw the list of layers, and the settings of the chosen one."""
    project = session.project
    if project is None:
        return []
    actions = _bar(project, look)
    frame = playback.current_frame(session, project)
    for figure in reversed(project.document.figures):
        actions += _row(project, look, figure, frame)
    if len(project.document.figures) == 1:
        small(look, "Drop another picture here, or open an .ora or .psd file, for more layers.")
    heading(look, project.figure.name)
    return actions + _settings(project, look, project.figure, frame)


def _bar(project: Project, look: Look) -> list[Action]:
    """Draw the buttons for whole layers."""
    actions = []
    active, figures = project.active, project.document.figures
    index = figures.index(project.figure)
    if icon_button(look, icons.ICON_FA_PLUS, "add layer", "Add a picture as a layer"):
        actions.append(do(layering.ask))
    imgui.same_line()
    if icon_button(look, icons.ICON_FA_CLONE, "copy layer", "Duplicate the layer"):
        actions.append(do(layering.duplicate, active))
    imgui.same_line()
    hint = "Bring the layer forward"
    is_last = index == len(figures) - 1
    if icon_button(look, icons.ICON_FA_ARROW_UP, "raise", hint, enabled=not is_last):
        actions.append(do(layering.move, active, index + 1))
    imgui.same_line()
    hint = "Send the layer back"
    if icon_button(look, icons.ICON_FA_ARROW_DOWN, "lower", hint, enabled=index > 0):
        actions.append(do(layering.move, active, index - 1))
    imgui.same_line()
    hint = "Delete the layer"
    if icon_button(look, icons.ICON_FA_TRASH, "delete layer", hint, enabled=len(figures) > 1):
        actions.append(do(layering.remove, active))
    return actions


def _row(project: Project, look: Look, figure: Figure, frame: int) -> list[Action]:
    actions = []
    identity = figure.id
    eye = icons.ICON_FA_EYE_SLASH if figure.hidden else icons.ICON_FA_EYE
    hint = "Show the layer" if figure.hidden else "Hide the layer, also in exports"
    if icon_button(look, eye, f"eye {identity}", hint, active=figure.hidden):
        actions.append(do(layering.show, identity))
    imgui.same_line(0, 0)
    key = icons.ICON_FA_LOCK if figure.locked else icons.ICON_FA_LOCK_OPEN
    hint = "Let clicks reach the layer" if figure.locked else "Let clicks pass through the layer"
    if icon_button(look, key, f"lock {identity}", hint, active=figure.locked):
        actions.append(do(layering.lock, identity))
    imgui.same_line()
    is_seen = is_visible(figure, frame)
    imgui.push_style_color(imgui.Col_.text, look.palette.text if is_seen else look.palette.dim)
    icon = icons.ICON_FA_IMAGE if figure.still else icons.ICON_FA_PERSON
    text = f"{icon}  {shortened(figure.name, imgui.get_content_region_avail().x - 3 * look.em)}"
    size = ImVec2(0, imgui.get_frame_height())
    imgui.push_style_var(imgui.StyleVar_.selectable_text_align, ImVec2(0, 0.5))
    # A selectable begins at the line's text, which the buttons before it have put lower.
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() - imgui.get_style().frame_padding.y)
    if imgui.selectable(f"{text}###row {identity}", identity == project.active, 0, size)[0]:
        actions.append(do(layering.choose, identity))
    imgui.pop_style_var()
    imgui.pop_style_color()
    return actions + _drag(project, figure)


def _drag(project: Project, figure: Figure) -> list[Action]:
    """Let a row be dragged to the place of another one."""
    actions = []
    if imgui.begin_drag_drop_source():
        imgui.set_drag_drop_payload_py_id(MOVED, figure.id)
        imgui.text(figure.name)
        imgui.end_drag_drop_source()
    if imgui.begin_drag_drop_target():
        payload = imgui.accept_drag_drop_payload_py_id(MOVED)
        if payload is not None:
            index = project.document.figures.index(figure)
            actions.append(do(layering.move, payload.data_id, index))
        imgui.end_drag_drop_target()
    return actions


def _settings(project: Project, look: Look, figure: Figure, frame: int) -> list[Action]:
    actions = []
    identity = figure.id
    label(look, "Name")
    entered, name = imgui.input_text(
        "##layer name", figure.name, imgui.InputTextFlags_.enter_returns_true
    )
    if entered or (imgui.is_item_deactivated_after_edit() and name != figure.name):
        actions.append(do(layering.rename, identity, name))
    label(look, "Opacity")
    hint = "How much of what lies behind is covered"
    faded = slider(look, "opacity", 100 * figure.opacity, PERCENT, text="%.0f %%", hint=hint)
    if faded is not None:
        actions.append(do(layering.fade, identity, min(max(faded.value / 100, 0.0), 1.0)))
    changed, _ = imgui.checkbox("Reference only", figure.reference)
    tip("Seen while you work, left out of exports")
    if changed:
        actions.append(do(layering.refer, identity))
    actions += _switch(look, figure, frame)
    actions += _joint(project, look, figure)
    if figure.still:
        small(look, "A still picture: it is shown as it was drawn.")
        if imgui.button("Let it be posed", ImVec2(FILL, 0)):
            actions.append(do(layering.stand_up, identity))
    elif imgui.button("Make it a still picture", ImVec2(FILL, 0)):
        actions.append(do(layering.stand_still, identity))
    return actions


def _switch(look: Look, figure: Figure, frame: int) -> list[Action]:
    """Draw what shows or hides a layer from the present frame on."""
    actions = []
    is_seen = is_visible(figure, frame)
    imgui.begin_disabled(figure.hidden)
    if imgui.button(f"{'Hide' if is_seen else 'Show'} from frame {frame} on", ImVec2(FILL, 0)):
        actions.append(do(layering.switch_here, figure.id))
    imgui.end_disabled()
    tip("For mouths, blinks and props: layers that take turns")
    is_switched = any(switch.frame == frame for switch in figure.switches)
    if is_switched and imgui.button(f"No change at frame {frame}", ImVec2(FILL, 0)):
        actions.append(do(layering.unswitch_here, figure.id))
    if figure.switches:
        told = (f"{'shown' if s.visible else 'hidden'} from {s.frame}" for s in figure.switches)
        small(look, "This layer is " + ", ".join(told) + ".")
    return actions


def _joint(project: Project, look: Look, figure: Figure) -> list[Action]:
    """Draw what a layer hangs on."""
    document = project.document
    others = [
        other
        for other in document.figures
        if all(carrier.id != figure.id for carrier in document.carriers(other.id))
    ]
    if not others and figure.attachment is None:
        return []
    actions = []
    joint = figure.attachment
    label(look, "Attached to")
    now = NOTHING if joint is None else document.figure(joint.to).name
    if imgui.begin_combo("##attached to", now):
        if imgui.selectable(NOTHING, joint is None)[0] and joint is not None:
            actions.append(do(layering.let_hang, figure.id))
        for other in others:
            is_parent = joint is not None and joint.to == other.id
            if imgui.selectable(f"{other.name}###parent {other.id}", is_parent)[0]:
                actions.append(do(layering.hang, figure.id, other.id))
        imgui.end_combo()
    tip("The layer moves with the place of the other one that is under its anchor now")
    if joint is not None:
        changed, turns = imgui.checkbox("Turns with it", joint.turns)
        if changed:
            actions.append(do(layering.turn_with, figure.id, turns))
    return actions
