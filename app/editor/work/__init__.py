"""What goes on behind the scenes: jobs of the workers, and what they are to bring.

In: pure computations on frozen input.
Out: their results, on the main thread; promises of what will change the document.
Imports: `app.document`, `app.solving`, `app.editor.action`.
"""

from app.editor.work.carry import Carry as Carry, Sample as Sample, Take as Take
from app.editor.work.derived import Derived as Derived
from app.editor.work.jobs import Job as Job, Jobs as Jobs, Kind as Kind
from app.editor.work.motion_draft import (
    MotionDraft as MotionDraft,
    MotionErrand as MotionErrand,
)
from app.editor.work.promise import Afterwards as Afterwards, Promise as Promise
from app.editor.work.pull import (
    MOST_STEPS as MOST_STEPS,
    Pull as Pull,
    Start as Start,
    WishFrom as WishFrom,
    pulled_by as pulled_by,
    targets_of as targets_of,
    wherever as wherever,
)
from app.editor.work.puppet import Puppet as Puppet, Twin as Twin
