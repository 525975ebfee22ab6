"""The layers of the scene: which there are, what is in front, what hangs on what."""

from imgui_bundle import imgui

from app.document import alternates, whole_groups
from app.editor import Action, Project, Session, do, layering
from app.editor.actions import files, playback, rebuilding
from app.errors import few_notices
from app.ui.panels.layers.menus import kept_whole
from app.ui.panels.layers.settings import draw_settings
from app.ui.panels.layers.tree import SmallPictures, draw_tree
from app.ui.style import Look, heading, progress, shortened, small

_FOLD = imgui.TreeNodeFlags_.no_tree_push_on_open | imgui.TreeNodeFlags_.span_avail_width


def draw(session: Session, look: Look, project: Project, pictures: SmallPictures) -> list[Action]:
    """Draw the list of layers with their small pictures, and the settings of the chosen one."""
    actions = _summary(look, project) + _offers(look, project)
    actions += draw_tree(session, look, project, pictures)
    if len(project.document.layers) == 1:
        small(look, "Drop another picture here, or open an .ora or .psd file, for more layers.")
    renewal = project.renewal
    if renewal is not None and renewal.replaces and progress(renewal.progress, renewal.now):
        actions.append(do(rebuilding.cancel))
    heading(look, shortened(project.layer.name, imgui.get_content_region_avail().x))
    frame = playback.current_frame(session, project)
    return actions + draw_settings(project, look, project.layer, frame)


def _summary(look: Look, project: Project) -> list[Action]:
    """Draw what opening the drawing told: what is lost first, and small matters folded."""
    summary = project.document.told
    if not summary:
        return []
    count = len(summary.losses)
    title = "Nothing looks different here" if not count else f"What looks different here: {count}"
    imgui.set_next_item_open(project.shows_summary)
    is_open = imgui.tree_node_ex(f"{title}###summary", _FOLD)
    actions = [do(files.fold_summary)] if imgui.is_item_toggled_open() else []
    if not is_open:
        return actions
    for loss in few_notices(summary.losses):
        small(look, loss, look.palette.text)
    if summary.matters and imgui.tree_node_ex(f"Small matters: {len(summary.matters)}", _FOLD):
        for matter in few_notices(summary.matters):
            small(look, matter)
    imgui.separator()
    return actions


def _offers(look: Look, project: Project) -> list[Action]:
    """Draw the offers to let layers of a group take turns, where it is named like mouths."""
    actions: list[Action] = []
    for path, layers in alternates(project.document):
        if path in project.declined:
            continue
        name = path.rpartition("/")[2]
        imgui.push_id(path)
        small(look, f"The {len(layers)} layers of {name} look as if they took turns.")
        whole = whole_groups(project.document, path)
        if whole:
            small(look, f"{kept_whole(whole)}.")
        if imgui.button("Let them take turns"):
            actions.append(do(layering.form, *layers, name=name))
        imgui.same_line()
        if imgui.button("No"):
            actions.append(do(layering.decline, path))
        imgui.pop_id()
    return actions
