"""Background work: jobs of the workers, and pending changes.

In: pure computations on frozen input.
Out: their results, on the main thread; pending changes of the document.
Imports: `app.document`, `app.solving`, `app.editor.action`.
"""

from app.editor.work.derived import Derived as Derived
from app.editor.work.jobs import Job as Job, JobKind as JobKind, Jobs as Jobs
from app.editor.work.layer_runtime import (
    ComparisonRuntime as ComparisonRuntime,
    LayerRuntime as LayerRuntime,
)
from app.editor.work.motion_setup import (
    MotionJob as MotionJob,
    MotionSetup as MotionSetup,
)
from app.editor.work.promise import Afterwards as Afterwards, Promise as Promise
from app.editor.work.pull import (
    MOST_STEPS as MOST_STEPS,
    DragStart as DragStart,
    Pull as Pull,
    TargetChange as TargetChange,
    absolute_targets as absolute_targets,
    combine_targets as combine_targets,
    find_changed_handles as find_changed_handles,
)
from app.editor.work.track_drag import (
    RecordedSample as RecordedSample,
    Recording as Recording,
    TrackDrag as TrackDrag,
)
