"""The state of one window, and everything that changes it.

In: actions of the person, and the clock.
Out: a `Session`: the document, what is shown of it, and what is under way.
Imports: every room below but the command line and the panels.
"""

from app.editor.action import Action, do
from app.editor.failures import sentence
from app.editor.jobs import Jobs
from app.editor.session import (
    Boxing,
    CurveKind,
    Dialog,
    ExportRun,
    FileDialog,
    HeatMap,
    Overlays,
    Project,
    Pulling,
    Puppet,
    Question,
    Session,
    ShortcutSheet,
    Toast,
    Turning,
)
from app.editor.timeline_view import Edge, EdgeDrag, KeyBox, KeyDrag, Scrub, Strip, TimeGesture

__all__ = [
    "Action",
    "Boxing",
    "CurveKind",
    "Dialog",
    "Edge",
    "EdgeDrag",
    "ExportRun",
    "FileDialog",
    "HeatMap",
    "Jobs",
    "KeyBox",
    "KeyDrag",
    "Overlays",
    "Project",
    "Pulling",
    "Puppet",
    "Question",
    "Scrub",
    "Session",
    "ShortcutSheet",
    "Strip",
    "TimeGesture",
    "Toast",
    "Turning",
    "do",
    "sentence",
]
