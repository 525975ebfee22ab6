"""Menu bar, icon bar and status bar."""

from typing import NamedTuple

from imgui_bundle import ImVec2, imgui

from app.editor import Action, Project, Session
from app.reports import Extremes
from app.ui import backdrop_menu
from app.ui.shortcuts import BINDINGS, Binding
from app.ui.style import Look, icon_button, ink, tip

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
SLOW = 0.3  # seconds after which a job is told of; shorter ones would only flicker
AT_BOUND = 0.97  # of a bound: so much of it is used where a pose cannot go on
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
        if title == "View":
            actions += backdrop_menu.draw(session)
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


class _Fact(NamedTuple):
    """Something at the right of the status bar."""

    text: str
    what: str  # in its tooltip
    warns: bool = False


def draw_status(session: Session, look: Look) -> list[Action]:
    """Draw the status bar: what goes on, and how the project and the window are."""
    slow = session.jobs.running_for(SLOW)
    if slow:
        _spinner(session, look)
        imgui.text_unformatted(f"{slow[0]}…")
    else:
        imgui.text_disabled(session.hint or "Ready")
    gap = 1.6 * look.em
    facts = _facts(session)
    width = sum(imgui.calc_text_size(fact.text).x + gap for fact in facts)
    imgui.same_line(imgui.get_window_width() - width + gap - look.em)
    for fact in facts:
        imgui.text_colored(look.palette.warning if fact.warns else look.palette.dim, fact.text)
        tip(fact.what)
        imgui.same_line(0, gap)
    imgui.new_line()
    return []


def _facts(session: Session) -> list[_Fact]:
    facts = []
    project = session.project
    if project is not None:
        distortion = _distortion(project)
        facts += [distortion] if distortion else []
        count = len(project.document.handles)
        facts.append(_Fact(f"{count} handle{'' if count == 1 else 's'}", "Handles of this drawing"))
    if session.solver_seconds:
        milliseconds = 1e3 * session.solver_seconds
        facts.append(_Fact(f"solver {milliseconds:.0f} ms", "What the last step of a pose took"))
    return [*facts, _Fact(f"{imgui.get_io().framerate:.0f} fps", "Frames per second")]


def _distortion(project: Project) -> _Fact | None:
    """Return the largest distortion that is shown, of the kind that is nearest to its bound."""
    shown, curves, document = project.shown, project.curves, project.document
    if shown is None:
        return None
    if shown.pose is not None:
        proven = shown.pose.certificate
        extremes = Extremes(proven.k, proven.sigma_a, proven.sigma_b)
    elif curves is not None and curves.document is document:
        extremes = curves.extremes_at(shown.frame)
    else:
        return None
    uses = extremes.uses(document.bounds)
    most = max(uses, key=lambda use: use.share)
    return _Fact(
        f"{most.name} {most.value:.2f} {most.sign} {most.bound:.2f}",
        "\n".join(
            ["Largest distortion of the whole shape, and its bound", ""]
            + [f"{use.name} {use.value:.3f} {use.sign} {use.bound:.3f}" for use in uses]
        ),
        warns=most.share > AT_BOUND,
    )


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
