"""The manual's page for each tab."""

from app.editor import Session
from app.editor.actions import viewing
from app.ui.panel import is_in_front

START = "index"
# Page by the title of the tab.
PAGES = {
    "Handle": "handles",
    "Layers": "layers",
    "Poses": "poses",
    "Motion": "ready-motions",
    "Deform": "stretch",
    "Material": "stiff",
    "Distortion": "distortion",
    "Mesh": "mesh",
    "Cut-out": "cut-out",
    "Export": "export",
}


def open_manual_page(session: Session) -> None:
    """Open the manual at the page of the active tool, or else of the front tab."""
    viewing.open_manual(session, find_manual_page(session))


def find_manual_page(session: Session) -> str:
    """Return the manual's page about the active tool, or else about the front tab."""
    project = session.project
    if project is None:
        return START
    tools = {
        "start": session.tutorial is not None,
        "cut-out": session.cutting is not None,
        "stiff": session.material is not None,
        "ready-motions": project.motion_setup is not None,
        "move": session.moves,
        "record": session.records,
        "camera": project.is_camera_view,
    }
    tabs = (page for tab, page in PAGES.items() if is_in_front(tab))
    return next((page for page, is_so in tools.items() if is_so), next(tabs, START))
