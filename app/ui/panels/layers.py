"""The layers of the scene: which there are, what is in front, what hangs on what."""

from imgui_bundle import ImVec2, imgui

from app.document import BLENDS, Document, Figure, Group, is_visible
from app.editor import Action, Project, Session, do, layering
from app.editor.actions import files, playback, rebuilding
from app.ui.panels.layer_list import SmallPictures, draw_list
from app.ui.style import (
    FILL,
    LABEL_WIDTH,
    Look,
    Scale,
    heading,
    label,
    progress,
    shortened,
    slider,
    small,
    text_button,
    tip,
)

PERCENT = Scale(left=0, right=100)
NOTHING = "nothing"
_FOLD = imgui.TreeNodeFlags_.no_tree_push_on_open | imgui.TreeNodeFlags_.span_avail_width


def draw(session: Session, look: Look, project: Project, pictures: SmallPictures) -> list[Action]:
    """Draw the list of layers with their small pictures, and the settings of the chosen one."""
    actions = _summary(look, project) + draw_list(session, look, project, pictures)
    if len(project.document.figures) == 1:
        small(look, "Drop another picture here, or open an .ora or .psd file, for more layers.")
    renewal = project.renewal
    if renewal is not None and renewal.replaces and progress(renewal.progress, renewal.now):
        actions.append(do(rebuilding.cancel))
    heading(look, shortened(project.figure.name, imgui.get_content_region_avail().x))
    frame = playback.current_frame(session, project)
    return actions + _settings(project, look, project.figure, frame)


def _summary(look: Look, project: Project) -> list[Action]:
    """Draw what opening the drawing told: what is lost first, and small matters folded."""
    summary = project.summary
    if not summary:
        return []
    count = len(summary.losses)
    title = "Nothing looks different here" if not count else f"What looks different here: {count}"
    imgui.set_next_item_open(project.shows_summary)
    is_open = imgui.tree_node_ex(f"{title}###summary", _FOLD)
    actions = [do(files.fold_summary)] if imgui.is_item_toggled_open() else []
    if not is_open:
        return actions
    for loss in summary.losses:
        small(look, loss, look.palette.text)
    if summary.matters and imgui.tree_node_ex(f"Small matters: {len(summary.matters)}", _FOLD):
        for matter in summary.matters:
            small(look, matter)
    imgui.separator()
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
    label(look, "Blend")
    if imgui.begin_combo("##blend", figure.blend):
        actions += [
            do(layering.blend, identity, blend)
            for blend in BLENDS
            if imgui.selectable(blend, blend == figure.blend)[0]
        ]
        imgui.end_combo()
    tip("How its colours meet those of what lies behind: multiply darkens, screen lightens")
    changed, _ = imgui.checkbox("Clipped", figure.clipped)
    tip("Seen only where that is which lies below it in its group")
    if changed:
        actions.append(do(layering.clip, identity))
    for group in project.document.groups_around(figure.group):
        actions += _group(look, group)
    changed, _ = imgui.checkbox("Reference only", figure.reference)
    tip("Seen while you work, left out of exports")
    if changed:
        actions.append(do(layering.refer, identity))
    actions += _switch(project.document, look, figure, frame)
    actions += _joint(project, look, figure, frame)
    if figure.still:
        small(look, "A still picture: it is shown as it was drawn.")
        if imgui.button("Let it be posed", ImVec2(FILL, 0)):
            actions.append(do(layering.stand_up, identity))
    elif imgui.button("Make it a still picture", ImVec2(FILL, 0)):
        actions.append(do(layering.stand_still, identity))
    return actions


def _group(look: Look, group: Group) -> list[Action]:
    """Draw the settings of a group that the chosen layer is in."""
    actions = []
    imgui.push_id(group.name)
    name = group.name.rpartition("/")[2]
    label(look, shortened(f"In {name}", (LABEL_WIDTH - 0.5) * look.em))
    hint = f"How much all layers of the group {group.name} together cover of what lies behind"
    faded = slider(look, "opacity", 100 * group.opacity, PERCENT, text="%.0f %%", hint=hint)
    if faded is not None:
        actions.append(do(layering.fade_group, group.name, min(max(faded.value / 100, 0.0), 1.0)))
    if imgui.checkbox(shortened(f"Hide all of {name}", 14 * look.em), group.hidden)[0]:
        actions.append(do(layering.show_group, group.name))
    imgui.pop_id()
    return actions


def _switch(document: Document, look: Look, figure: Figure, frame: int) -> list[Action]:
    """Draw what shows or hides a layer from the present frame on."""
    actions = []
    is_seen = is_visible(document, figure, frame)
    text = f"{'Hide' if is_seen else 'Show'} from frame {frame} on"
    hint = "For mouths, blinks and props: layers that take turns"
    is_away = figure.hidden or document.is_in_hidden_group(figure)
    if text_button(text, FILL, hint, enabled=not is_away):
        actions.append(do(layering.switch_here, figure.id))
    is_switched = any(switch.frame == frame for switch in figure.switches)
    if is_switched and imgui.button(f"No change at frame {frame}", ImVec2(FILL, 0)):
        actions.append(do(layering.unswitch_here, figure.id))
    if figure.switches:
        told = (f"{'shown' if s.visible else 'hidden'} from {s.frame}" for s in figure.switches)
        small(look, "This layer is " + ", ".join(told) + ".")
    return actions


def _joint(project: Project, look: Look, figure: Figure, frame: int) -> list[Action]:
    """Draw what a layer hangs on."""
    document = project.document
    others = [
        other for other in document.figures if not layering.hangs_on(project, other.id, figure.id)
    ]
    if not others and not figure.joints:
        return []
    actions = []
    joint = figure.joint_at(frame)
    parent = None if joint is None or joint.to is None else document.figure(joint.to)
    label(look, "Attached to")
    now = NOTHING if parent is None else parent.name
    if imgui.begin_combo("##attached to", now):
        if imgui.selectable(NOTHING, parent is None)[0] and parent is not None:
            actions.append(do(layering.let_hang, figure.id))
        actions += [
            do(layering.hang, figure.id, other.id)
            for other in others
            if imgui.selectable(f"{other.name}###parent {other.id}", other is parent)[0]
        ]
        imgui.end_combo()
    tip("The layer moves with the place of the other one that is under its anchor now")
    if joint is not None and parent is not None:
        changed, turns = imgui.checkbox("Turns with it", joint.turns)
        if changed:
            actions.append(do(layering.turn_with, figure.id, turns))
    return actions
