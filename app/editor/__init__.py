"""The state of one window, and all changes of it.

In: actions of the person, and the clock.
Out: a `Session`: the document, the shown frame, and background work.
Imports: every room below but the command line and the panels.
"""

from app.editor import (
    error_reports as error_reports,
    layering as layering,
    pending_changes as pending_changes,
)
from app.editor.action import Action as Action, do as do
from app.editor.error_reports import as_sentence as as_sentence
from app.editor.parts.dialogs import (
    Dialog as Dialog,
    FileDialog as FileDialog,
    ProblemReport as ProblemReport,
    Question as Question,
    RecoverableFile as RecoverableFile,
    RecoveryDialog as RecoveryDialog,
    ReloadDialog as ReloadDialog,
    ShortcutSheet as ShortcutSheet,
)
from app.editor.parts.export_state import ExportRun as ExportRun
from app.editor.parts.notices import Toast as Toast
from app.editor.parts.timeline.gestures import (
    CurvePoint as CurvePoint,
    CycleDrag as CycleDrag,
    Edge as Edge,
    EdgeDrag as EdgeDrag,
    GraphGesture as GraphGesture,
    GraphPlace as GraphPlace,
    KeyBox as KeyBox,
    KeyDrag as KeyDrag,
    PointBox as PointBox,
    PointDrag as PointDrag,
    PointScale as PointScale,
    ScrubDrag as ScrubDrag,
    SoundDrag as SoundDrag,
    TangentDrag as TangentDrag,
    TimeDrag as TimeDrag,
    TimeGesture as TimeGesture,
)
from app.editor.parts.timeline.graph import NumberRanges as NumberRanges
from app.editor.parts.timeline.time_range import TimeRangeView as TimeRangeView
from app.editor.parts.tools import CutTool as CutTool, Hint as Hint, StiffnessTool as StiffnessTool
from app.editor.parts.viewport_state import (
    CurveKind as CurveKind,
    HeatMap as HeatMap,
    Overlays as Overlays,
    Tint as Tint,
)
from app.editor.project import Project as Project
from app.editor.session import (
    Session as Session,
    TutorialStage as TutorialStage,
    TutorialState as TutorialState,
    with_project as with_project,
)
from app.editor.work.jobs import JobKind as JobKind, Jobs as Jobs
from app.editor.work.layer_runtime import (
    ComparisonRuntime as ComparisonRuntime,
    LayerRuntime as LayerRuntime,
)
