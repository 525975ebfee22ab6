"""The menu bar."""

from collections.abc import Callable, Sequence

from imgui_bundle import imgui

from app.document import PRESETS
from app.editor import Action, Session, do
from app.editor.actions import viewing
from app.editor.actions.action_spec import ActionSpec
from app.editor.actions.project_files import files
from app.editor.actions.timing import keys
from app.errors import display_name
from app.storage import CHECKER
from app.texts import _, list_languages
from app.ui.bars.methods import draw_method_menu
from app.ui.panel import Panel, is_in_front
from app.ui.shortcuts.table import MENUS, SUBMENUS
from app.ui.shortcuts.widgets import draw_action_item
from app.ui.shortcuts.window_actions import reset_layout
from app.ui.style.theme import Look
from app.ui.style.widgets import colour_field, draw_tooltip

PATH_REACHES = {
    0: _("All played frames"),
    6: _("6 around playhead"),
    12: "12",
    24: "24",
    48: "48",
}
BLACK = "#000000"
BACKDROPS = {
    _("Checker"): CHECKER,
    _("White"): "#ffffff",
    _("Grey"): "#808080",
    _("Black"): BLACK,
}

# By the name in the table of presets.
EASINGS = {
    "linear": _("Linear"),
    "in": _("In"),
    "out": _("Out"),
    "in-out": _("In-out"),
    "hold": _("Hold"),
}


def draw_main_menu(
    session: Session, _look: Look, *, title: str, panels: Sequence[Panel]
) -> list[Action]:
    """Draw the entries of a menu from the table of actions; `panels` are the window's."""
    actions: list[Action] = []
    was_submenu = False
    for number, group in enumerate(MENUS[title]):
        submenu = SUBMENUS.get(group[0])
        if number and not (was_submenu and submenu):
            imgui.separator()
        was_submenu = submenu is not None
        if submenu is not None and not imgui.begin_menu(_(submenu)):
            continue
        for spec in group:
            actions += draw_action_item(session, spec)
            if spec in BELOW:
                actions += BELOW[spec](session)
            if spec is reset_layout:
                actions += _tabs(session, panels)
        if submenu is not None:
            imgui.end_menu()
    return actions


def _backdrops(session: Session) -> list[Action]:
    if not imgui.begin_menu(_("Backdrop")):
        return []
    current = session.settings.preferences.backdrop
    actions = [
        do(viewing.set_backdrop, backdrop)
        for name, backdrop in BACKDROPS.items()
        if imgui.menu_item(name, "", backdrop == current)[0]
    ]
    colour = colour_field("own colour", BLACK if current == CHECKER else current)
    if colour is not None:
        actions.append(do(viewing.set_backdrop, colour))
    imgui.end_menu()
    return actions


def _languages(session: Session) -> list[Action]:
    """Draw the menu of languages, each as it calls itself."""
    if not imgui.begin_menu(_("Language")):
        return []
    current = session.settings.preferences.language
    names = {"": _("As the system"), **list_languages()}
    actions = [
        do(viewing.set_language, code)
        for code, name in names.items()
        if imgui.menu_item(name, "", code == current)[0]
    ]
    imgui.separator()
    imgui.text_disabled(_("Used from the next start on"))
    imgui.end_menu()
    return actions


def _tabs(session: Session, panels: Sequence[Panel]) -> list[Action]:
    """Draw the menu of panels by name, because their tabs may be out of view."""
    if not imgui.begin_menu(_("Tabs"), session.project is not None):
        return []
    actions = [
        do(viewing.show_tab, panel.title)
        for panel in panels
        if panel.place == "side"
        and panel.has_tab(session)
        and imgui.menu_item(panel.label, "", is_in_front(panel.title))[0]
    ]
    imgui.end_menu()
    return actions


def _path_reaches(session: Session) -> list[Action]:
    if not imgui.begin_menu(_("Motion path frames")):
        return []
    current = session.settings.preferences.path_reach
    actions = [
        do(viewing.set_path_range, reach)
        for reach, name in PATH_REACHES.items()
        if imgui.menu_item(name, "", reach == current)[0]
    ]
    imgui.end_menu()
    return actions


def _new_keys(session: Session) -> list[Action]:
    """Draw the menu of the tangent and easing of new keys."""
    if not imgui.begin_menu(_("Easing of new keys")):
        return []
    actions = [
        do(keys.set_default_easing, preset)
        for name, preset in PRESETS.items()
        if imgui.menu_item(EASINGS[name], "", preset == session.settings.preferences.easing)[0]
    ]
    imgui.end_menu()
    return actions


def _methods(session: Session) -> list[Action]:
    """Draw the menu of interpolation methods."""
    project = session.project
    if not imgui.begin_menu(_("In-betweens"), project is not None):
        return []
    actions = draw_method_menu(project) if project is not None else []
    imgui.end_menu()
    return actions


def _recent(session: Session) -> list[Action]:
    recent = files.recent_files(session)
    if not imgui.begin_menu(_("Open recent"), bool(recent)):
        return []
    actions = []
    for index, (path, is_there) in enumerate(recent):
        # The text is grey but the entry is not disabled: a click removes the file from the list.
        colour = imgui.Col_.text if is_there else imgui.Col_.text_disabled
        imgui.push_style_color(imgui.Col_.text, imgui.get_style_color_vec4(colour))
        note = "" if is_there else _("not found")
        if imgui.menu_item(f"{display_name(path.name)}###recent {index}", note, False)[0]:  # noqa: FBT003
            actions.append(do(files.open_recent_file, path))
        imgui.pop_style_color()
        draw_tooltip(display_name(path))
    imgui.end_menu()
    return actions


# Submenus, by the entry above each.
BELOW: dict[ActionSpec, Callable[[Session], list[Action]]] = {
    files.ask_file_to_open: _recent,
    viewing.MOTION_PATHS: _path_reaches,
    viewing.shrink_interface: lambda session: _backdrops(session) + _languages(session),
    keys.EASE_KEYS[-1]: _new_keys,
    viewing.WIREFRAME: _methods,
}
