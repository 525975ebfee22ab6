"""The state of one window, and everything that changes it.

In: actions of the person, and the clock.
Out: a `Session`: the document, what is shown of it, and what is under way.
Imports: every room below but the command line and the panels.
"""

from app.editor import layering, promises
from app.editor.action import Action, do
from app.editor.dialogs import Dialog, FileDialog, Leftover, Question, Recovery, ShortcutSheet
from app.editor.failures import sentence
from app.editor.jobs import Jobs
from app.editor.project import Flip, PoseBlend, Project, Puppet, Twin
from app.editor.pull import Pull
from app.editor.session import (
    BoxMark,
    CurveKind,
    CutTool,
    EntryMark,
    ExportRun,
    HeatMap,
    Hint,
    JointMark,
    Overlays,
    Session,
    Split,
    StrokeMark,
    SweepMark,
    Toast,
    ToolInHand,
    with_project,
)
from app.editor.timeline_view import (
    Edge,
    EdgeDrag,
    KeyBox,
    KeyDrag,
    MarkerDrag,
    Scrub,
    Strip,
    SwitchDrag,
    TimeGesture,
)

__all__ = [
    "Action",
    "BoxMark",
    "CurveKind",
    "CutTool",
    "Dialog",
    "Edge",
    "EdgeDrag",
    "EntryMark",
    "ExportRun",
    "FileDialog",
    "Flip",
    "HeatMap",
    "Hint",
    "Jobs",
    "JointMark",
    "KeyBox",
    "KeyDrag",
    "Leftover",
    "MarkerDrag",
    "Overlays",
    "PoseBlend",
    "Project",
    "Pull",
    "Puppet",
    "Question",
    "Recovery",
    "Scrub",
    "Session",
    "ShortcutSheet",
    "Split",
    "Strip",
    "StrokeMark",
    "SweepMark",
    "SwitchDrag",
    "TimeGesture",
    "Toast",
    "ToolInHand",
    "Twin",
    "do",
    "layering",
    "promises",
    "sentence",
    "with_project",
]
