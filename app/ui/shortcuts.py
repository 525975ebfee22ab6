"""All keys in one table: menus, buttons, tooltips and the sheet of keys are made from it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from app.editor import Action, Session, do
from app.editor.actions import (
    editing,
    exporting,
    files,
    keys,
    playback,
    posing,
    saving,
    timeline_pointing,
    viewing,
)

Key = imgui.Key
Test = Callable[[Session], bool]


def always(_: Session) -> bool:
    """Tell that something can be done at any time."""
    return True


def with_project(session: Session) -> bool:
    """Tell whether a project is open."""
    return session.project is not None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Binding:
    """Something that has a name, and mostly keys.

    Parameters
    ----------
    label : str
        In menus and in the sheet of keys.
    action : Action
    group : str
        Under which the sheet lists it.
    keys : tuple of int
        ImGui's key chords; any of them does it.
    icon : str
    hint : str
        Tooltip; the label where it is empty.
    possible : callable
        Whether it can be done now.
    active : callable
        Whether what it switches is on.
    repeats : bool
        Whether it is done again while the key is held.
    """

    label: str
    action: Action
    group: str
    keys: tuple[int, ...] = ()
    icon: str = ""
    hint: str = ""
    possible: Test = with_project
    active: Test | None = None
    repeats: bool = False

    @property
    def keys_in_words(self) -> str:
        """The first of the keys, as menus show it."""
        return _in_words(self.keys[0]) if self.keys else ""


@cache
def _in_words(chord: int) -> str:
    parts = [name for modifier, name in MODIFIERS.items() if chord & modifier]
    key = imgui.get_key_name(Key(chord & ~sum(MODIFIERS)))
    return "+".join([*parts, KEY_NAMES.get(key, key)])


MODIFIERS = {int(Key.mod_ctrl): "Ctrl", int(Key.mod_shift): "Shift", int(Key.mod_alt): "Alt"}
KEY_NAMES = {
    "UpArrow": "Up",
    "DownArrow": "Down",
    "LeftArrow": "Left",
    "RightArrow": "Right",
    "PageUp": "PgUp",
    "PageDown": "PgDn",
    "Delete": "Del",
    "Equal": "+",
    "Minus": "−",
}


def _edits(session: Session) -> bool:
    return session.project is not None and bool(session.project.selected or session.project.chosen)


def _undoable(session: Session) -> bool:
    project = session.project
    return project is not None and (
        project.history.undo_label is not None or project.loose is not None
    )


def _redoable(session: Session) -> bool:
    return session.project is not None and session.project.history.redo_label is not None


def _no_handles_selected(session: Session) -> bool:
    return session.project is not None and not session.project.selected


# Whole numbers: combined as members, these keys fail to form a flag in Python 3.11.2.
CTRL, SHIFT = int(Key.mod_ctrl), int(Key.mod_shift)
BINDINGS: dict[str, Binding] = {
    "open": Binding(
        label="Open…",
        action=do(files.ask_open),
        group="File",
        keys=(CTRL | int(Key.o),),
        icon=icons.ICON_FA_FOLDER_OPEN,
        hint="Open a picture or a project",
        possible=always,
    ),
    "save": Binding(
        label="Save",
        action=do(saving.save),
        group="File",
        keys=(CTRL | int(Key.s),),
        icon=icons.ICON_FA_FLOPPY_DISK,
    ),
    "save as": Binding(
        label="Save as…", action=do(saving.save_as), group="File", keys=(CTRL | SHIFT | int(Key.s),)
    ),
    "export": Binding(
        label="Export…",
        action=do(exporting.ask),
        group="File",
        keys=(CTRL | int(Key.e),),
        icon=icons.ICON_FA_FILE_EXPORT,
    ),
    "export again": Binding(
        label="Export again",
        action=do(exporting.repeat),
        group="File",
        keys=(CTRL | SHIFT | int(Key.e),),
    ),
    "close": Binding(
        label="Close", action=do(saving.close), group="File", keys=(CTRL | int(Key.w),)
    ),
    "quit": Binding(
        label="Quit",
        action=do(saving.quit_lissom),
        group="File",
        keys=(CTRL | int(Key.q),),
        possible=always,
    ),
    "undo": Binding(
        label="Undo",
        action=do(editing.undo),
        group="Edit",
        keys=(CTRL | int(Key.z),),
        icon=icons.ICON_FA_ARROW_ROTATE_LEFT,
        possible=_undoable,
        repeats=True,
    ),
    "redo": Binding(
        label="Redo",
        action=do(editing.redo),
        group="Edit",
        keys=(CTRL | SHIFT | int(Key.z), CTRL | int(Key.y)),
        icon=icons.ICON_FA_ARROW_ROTATE_RIGHT,
        possible=_redoable,
        repeats=True,
    ),
    "select all": Binding(
        label="Select all handles",
        action=do(editing.select_all),
        group="Edit",
        keys=(CTRL | int(Key.a),),
    ),
    "delete": Binding(
        label="Delete",
        action=do(editing.delete),
        group="Edit",
        keys=(Key.delete, Key.backspace),
        icon=icons.ICON_FA_TRASH,
        possible=_edits,
    ),
    "fit": Binding(
        label="Fit to window",
        action=do(viewing.fit),
        group="View",
        keys=(Key.home,),
        icon=icons.ICON_FA_EXPAND,
    ),
    "actual size": Binding(
        label="Actual size",
        action=do(viewing.actual_size),
        group="View",
        keys=(Key._1,),  # noqa: SLF001 - its public name begins so
    ),
    "handles": Binding(
        label="Handles",
        action=do(viewing.toggle, "handles"),
        group="View",
        keys=(Key.h,),
        icon=icons.ICON_FA_CIRCLE_DOT,
        hint="Show or hide the handles",
        active=lambda session: session.overlays.handles,
    ),
    "wireframe": Binding(
        label="Wireframe",
        action=do(viewing.toggle, "wireframe"),
        group="View",
        keys=(Key.w,),
        icon=icons.ICON_FA_DRAW_POLYGON,
        hint="Show the triangles",
        active=lambda session: session.overlays.wireframe,
    ),
    "outline": Binding(
        label="Outline and cage",
        action=do(viewing.toggle, "outline"),
        group="View",
        keys=(Key.c,),
        icon=icons.ICON_FA_VECTOR_SQUARE,
        hint="Show the shape's outline and the cage around it",
        active=lambda session: session.overlays.outline,
    ),
    "heat map": Binding(
        label="Heat map",
        action=do(viewing.toggle_heat_map),
        group="View",
        keys=(Key.d,),
        icon=icons.ICON_FA_TEMPERATURE_HALF,
        hint="Colour the shape by its distortion",
        active=lambda session: session.overlays.heat_map != "none",
    ),
    "onion skin": Binding(
        label="Onion skin",
        action=do(viewing.toggle, "onion"),
        group="View",
        keys=(Key.o,),
        icon=icons.ICON_FA_GHOST,
        hint="Show the poses before and after",
        active=lambda session: session.overlays.onion,
    ),
    "theme": Binding(
        label="Light or dark",
        action=do(viewing.toggle_theme),
        group="View",
        icon=icons.ICON_FA_CIRCLE_HALF_STROKE,
        hint="Change between the light and the dark theme",
        possible=always,
    ),
    "larger": Binding(
        label="Larger interface",
        action=do(viewing.scale_up),
        group="View",
        keys=(CTRL | int(Key.equal), CTRL | int(Key.keypad_add)),
        possible=always,
    ),
    "smaller": Binding(
        label="Smaller interface",
        action=do(viewing.scale_down),
        group="View",
        keys=(CTRL | int(Key.minus), CTRL | int(Key.keypad_subtract)),
        possible=always,
    ),
    "play": Binding(
        label="Play",
        action=do(playback.toggle_play),
        group="Time",
        icon=icons.ICON_FA_PLAY,
        hint="Play or halt (tap Space)",
        active=lambda session: (
            session.project is not None and session.project.playhead.since is not None
        ),
    ),
    "start": Binding(
        label="First frame",
        action=do(playback.to_start),
        group="Time",
        keys=(CTRL | int(Key.page_up),),
        icon=icons.ICON_FA_BACKWARD_FAST,
    ),
    "end": Binding(
        label="Last frame",
        action=do(playback.to_end),
        group="Time",
        keys=(CTRL | int(Key.page_down),),
        icon=icons.ICON_FA_FORWARD_FAST,
    ),
    "back": Binding(
        label="Previous frame",
        action=do(playback.step, -1),
        group="Time",
        keys=(Key.page_up,),
        icon=icons.ICON_FA_BACKWARD_STEP,
        repeats=True,
    ),
    "on": Binding(
        label="Next frame",
        action=do(playback.step, 1),
        group="Time",
        keys=(Key.page_down,),
        icon=icons.ICON_FA_FORWARD_STEP,
        repeats=True,
    ),
    "previous key": Binding(
        label="Previous keyframe",
        action=do(playback.to_key, -1),
        group="Time",
        keys=(Key.down_arrow,),
        possible=_no_handles_selected,
        repeats=True,
    ),
    "next key": Binding(
        label="Next keyframe",
        action=do(playback.to_key, 1),
        group="Time",
        keys=(Key.up_arrow,),
        possible=_no_handles_selected,
        repeats=True,
    ),
    "loop": Binding(
        label="Loop",
        action=do(keys.toggle_loop),
        group="Time",
        keys=(Key.l,),
        icon=icons.ICON_FA_REPEAT,
        hint="Loop: the end leads back to the beginning",
        active=lambda session: session.project is not None and session.project.document.loop,
    ),
    "fit time": Binding(
        label="Fit timeline",
        action=do(timeline_pointing.fit),
        group="Time",
        keys=(SHIFT | int(Key.home),),
        icon=icons.ICON_FA_ARROWS_LEFT_RIGHT_TO_LINE,
        hint="Show all frames",
    ),
    "work start": Binding(
        label="Start work range here",
        action=do(keys.start_work_here),
        group="Time",
        keys=(Key.b,),
    ),
    "work end": Binding(
        label="End work range here", action=do(keys.end_work_here), group="Time", keys=(Key.n,)
    ),
    "insert key": Binding(
        label="Insert key",
        action=do(posing.insert_key),
        group="Time",
        keys=(Key.i,),
        icon=icons.ICON_FA_DIAMOND,
        hint="Hold the pose that is shown in a key",
    ),
    "auto-key": Binding(
        label="Auto-key",
        action=do(viewing.toggle_auto_key),
        group="Time",
        keys=(Key.k,),
        icon=icons.ICON_FA_KEY,
        hint="Posing makes and changes keys by itself",
        active=lambda session: session.preferences.auto_key,
    ),
    "shortcuts": Binding(
        label="Keys and mouse",
        action=do(viewing.show_shortcuts),
        group="Help",
        keys=(Key.f1,),
        icon=icons.ICON_FA_KEYBOARD,
        possible=always,
    ),
}


def pressed(session: Session) -> list[Action]:
    """Return the actions whose keys were pressed, unless the person types into a field."""
    if imgui.get_io().want_text_input or session.dialog is not None:
        return []
    actions = []
    for binding in BINDINGS.values():
        flags = imgui.InputFlags_.route_always
        if binding.repeats:
            flags |= imgui.InputFlags_.repeat
        if any(imgui.shortcut(keys, flags) for keys in binding.keys) and binding.possible(session):
            actions.append(binding.action)
    return actions + _nudges(session) + _space(session)


def _nudges(session: Session) -> list[Action]:
    if session.project is None or not session.project.selected:
        return []
    reach = 10.0 if imgui.get_io().key_shift else 1.0
    return [
        do(posing.nudge, reach * direction)
        for key, direction in ARROWS.items()
        if imgui.is_key_pressed(key)
    ]


def _space(session: Session) -> list[Action]:
    """Return playing where Space was tapped, and not held to move the view."""
    if session.project is None or not imgui.is_key_released(Key.space):
        return []
    return [do(playback.tap_space)]


ARROWS = {Key.left_arrow: -1, Key.right_arrow: 1, Key.up_arrow: 1j, Key.down_arrow: -1j}
