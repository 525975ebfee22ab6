"""Which menus, tabs and tools a picture of the window shows."""

import json
from pathlib import Path

from harness import Harness, Robot

from app.editor import Jobs, Session
from app.editor.parts.settings import SessionSettings
from app.render import Renderer
from app.render.gpu.context import create_context
from app.ui.bars.tools import POSE, TOOLS
from app.ui.shortcuts.table import MENUS
from app.ui.window.window import Window

Shown = dict[str, list[str]]
# How the test engine finds the item of a name.
ITEMS = {"menus": "##MainMenuBar/##MenuBar/{}", "tabs": "**/###{}", "tools": "**/###{}"}


def shown_now() -> Shown:
    """Return what the window is made to show while a drawing is open, by the program's tables.

    These are the titles of the menus and of the tabs at the side, and the tools of the icon bar.
    Nothing is drawn for it.
    """
    session = Session(clock=lambda: 0.0, jobs=Jobs(), settings=SessionSettings(folder=Path()))
    params = Window(session, lambda: Renderer(create_context())).runner_params()
    return {
        "menus": list(MENUS),
        "tabs": [
            panel.label.rpartition("###")[2]
            for panel in params.docking_params.dockable_windows
            if panel.dock_space_name == "side" and panel.is_visible
        ],
        "tools": [POSE, *(spec.label for spec in TOOLS)],
    }


def shown_in(window: Harness) -> Shown:
    """Return what is really found in a running window."""
    found: Shown = {}

    def look(robot: Robot) -> None:
        for kind, names in shown_now().items():
            found[kind] = [name for name in names if robot.item_exists(ITEMS[kind].format(name))]

    window.run(look)
    return found


def write_list(picture: Path, shown: Shown) -> None:
    """Write what a picture shows into the file beside it."""
    text = json.dumps(shown, indent=2, ensure_ascii=False)
    picture.with_suffix(".json").write_text(f"{text}\n", encoding="utf-8")
