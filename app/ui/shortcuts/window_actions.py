"""Actions that need to know the window's tabs: the manual's page, the export, the layout."""

from imgui_bundle import hello_imgui

from app.editor import Session
from app.editor.actions import dialog_actions
from app.editor.actions.action_spec import named_action
from app.editor.actions.project_files import export_settings
from app.texts import _
from app.ui.panel import bring_to_front, is_in_front

START = "index"
# Page by the title of the tab.
PAGES = {
    "Handle": "handles",
    "Layers": "layers",
    "Animate": "poses",
    "Shape": "stretch",
    "Export": "export",
    "Measure": "distortion",
}


@named_action(_("Manual"), "F1", needs_project=False)
def open_manual_page(session: Session) -> None:
    """Open the manual at the page of the active tool, or else of the front tab."""
    dialog_actions.open_manual(session, find_manual_page(session))


def find_manual_page(session: Session) -> str:
    """Return the manual's page about the active tool, or else about the front tab."""
    project = session.project
    if project is None:
        return START
    tools = {
        "start": session.tutorial.state is not None,
        "cut-out": session.tools.is_cutting,
        "stiff": session.tools.stiffness_tool is not None,
        "ready-motions": session.tools.motion_setup is not None,
        "move": session.tools.mode == "move",
        "record": session.tools.mode == "record",
        "camera": project.viewport.is_camera_view,
    }
    tabs = (page for tab, page in PAGES.items() if is_in_front(tab))
    return next((page for page, is_so in tools.items() if is_so), next(tabs, START))


@named_action(_("Export…"), "Ctrl+E")
def show_export(session: Session) -> None:
    """Show the export panel. If it is in front already, ask for the file and begin."""
    if session.display.is_panel_folded:
        session.display.focus_panel("Export")
    elif bring_to_front("Export"):
        export_settings.ask_destination_and_export(session)


@named_action(_("Reset layout"), needs_project=False)
def reset_layout(_session: Session) -> None:
    hello_imgui.get_runner_params().docking_params.layout_reset = True
