"""The state of one window, and everything that changes it.

In: actions of the person, and the clock.
Out: a `Session`: the document, what is shown of it, and what is under way.
Imports: every room below but the command line and the panels.
"""

from app.editor import failures as failures, layering as layering, promises as promises
from app.editor.action import Action as Action, do as do
from app.editor.dialogs import (
    Dialog as Dialog,
    FileDialog as FileDialog,
    Leftover as Leftover,
    ProblemReport as ProblemReport,
    Question as Question,
    Recovery as Recovery,
    ShortcutSheet as ShortcutSheet,
)
from app.editor.failures import sentence as sentence
from app.editor.project import Project as Project
from app.editor.session import (
    BoneMark as BoneMark,
    BoxMark as BoxMark,
    CurveKind as CurveKind,
    CutTool as CutTool,
    EntryMark as EntryMark,
    ExportRun as ExportRun,
    Guide as Guide,
    GuideStep as GuideStep,
    HeatMap as HeatMap,
    Hint as Hint,
    JointMark as JointMark,
    KnifeMark as KnifeMark,
    Mark as Mark,
    MaterialTool as MaterialTool,
    Overlays as Overlays,
    Session as Session,
    StrokeMark as StrokeMark,
    SweepMark as SweepMark,
    Tint as Tint,
    Toast as Toast,
    with_project as with_project,
)
from app.editor.timeline_view import (
    CameraDrag as CameraDrag,
    CycleDrag as CycleDrag,
    Edge as Edge,
    EdgeDrag as EdgeDrag,
    KeyBox as KeyBox,
    KeyDrag as KeyDrag,
    KeyRow as KeyRow,
    KeysOf as KeysOf,
    MarkerDrag as MarkerDrag,
    Scrub as Scrub,
    Strip as Strip,
    SwitchDrag as SwitchDrag,
    TimeDrag as TimeDrag,
    TimeGesture as TimeGesture,
    TrackRow as TrackRow,
    TurnDrag as TurnDrag,
    frames_in as frames_in,
    layer_of as layer_of,
    row_of as row_of,
    seen_at as seen_at,
)
from app.editor.work import Jobs as Jobs, Kind as Kind, Puppet as Puppet, Twin as Twin
