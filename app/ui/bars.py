"""Menu bar, icon bar and status bar."""

from imgui_bundle import ImVec2, imgui

from app.actions.action import Action
from app.session import Session
from app.ui.shortcuts import BINDINGS, Binding
from app.ui.theme import Look, ink
from app.ui.widgets import icon_button

MENUS: dict[str, tuple[str, ...]] = {
    "File": ("open", "", "save", "save as", "", "export", "export again", "", "close", "quit"),
    "Edit": ("undo", "redo", "", "select all", "delete"),
    "View": (
        *("fit", "actual size", "", "handles", "wireframe", "outline", "heat map", "onion skin"),
        *("", "theme", "larger", "smaller"),
    ),
    "Time": (
        "play",
        "start",
        "end",
        "back",
        "on",
        "previous key",
        "next key",
        "",
        "insert key",
        "loop",
        "auto-key",
        "",
        "work start",
        "work end",
        "fit time",
    ),
    "Help": ("shortcuts",),
}
ICON_BAR = ("fit", "", "handles", "wireframe", "outline", "heat map", "onion skin", "", "auto-key")


def draw_menus(session: Session, _: Look) -> list[Action]:
    """Draw the menus; their items come from the table of keys."""
    actions: list[Action] = []
    for title, names in MENUS.items():
        if not imgui.begin_menu(title):
            continue
        for name in names:
            if name:
                actions += _menu_item(session, BINDINGS[name])
            else:
                imgui.separator()
        imgui.end_menu()
    return actions


def _menu_item(session: Session, binding: Binding) -> list[Action]:
    active = binding.active is not None and binding.active(session)
    label = _label(session, binding)
    clicked, _ = imgui.menu_item(label, binding.keys_in_words, active, binding.possible(session))
    return [binding.action] if clicked else []


def _label(session: Session, binding: Binding) -> str:
    history = session.project.history if session.project else None
    if history is not None and binding is BINDINGS["undo"] and history.undo_label:
        return f"{binding.label} “{history.undo_label}”###{binding.label}"
    if history is not None and binding is BINDINGS["redo"] and history.redo_label:
        return f"{binding.label} “{history.redo_label}”###{binding.label}"
    return binding.label


def draw_icons(session: Session, look: Look) -> list[Action]:
    """Draw the slim bar of switches at the left."""
    actions: list[Action] = []
    if session.project is None:
        return actions
    for name in ICON_BAR:
        if not name:
            imgui.dummy(ImVec2(0, 0.4 * look.em))
            continue
        actions += bound_button(session, look, name)
    return actions


def bound_button(session: Session, look: Look, name: str, icon: str = "") -> list[Action]:
    """Draw the button of a named action of the table of keys."""
    binding = BINDINGS[name]
    is_pressed = icon_button(
        look,
        icon or binding.icon,
        binding.label,
        binding.hint or binding.label,
        keys=binding.keys_in_words,
        active=binding.active is not None and binding.active(session),
        enabled=binding.possible(session),
    )
    return [binding.action] if is_pressed else []


def draw_status(session: Session, look: Look) -> list[Action]:
    """Draw the status bar: what goes on, and what the project is made of."""
    busy = session.jobs.kinds
    if busy:
        _spinner(session, look)
        imgui.text_unformatted(f"{busy[0]}…")
    else:
        imgui.text_disabled(session.hint or "Ready")
    facts = f"{imgui.get_io().framerate:.0f} fps"
    if session.project is not None:
        document = session.project.document
        facts = f"{len(document.handles)} handles     {facts}"
    width = imgui.calc_text_size(facts).x
    imgui.same_line(imgui.get_window_width() - width - look.em)
    imgui.text_disabled(facts)
    return []


def _spinner(session: Session, look: Look) -> None:
    corner = imgui.get_cursor_screen_pos()
    radius = 0.35 * look.em
    centre = ImVec2(corner.x + radius, corner.y + 0.5 * look.em)
    draw_list = imgui.get_window_draw_list()
    start = 6.0 * session.clock()
    draw_list.path_arc_to(centre, radius, start, start + 4.5, 20)
    draw_list.path_stroke(ink(look.palette.accent), 0.14 * look.em)
    imgui.dummy(ImVec2(2 * radius, look.em))
    imgui.same_line()
