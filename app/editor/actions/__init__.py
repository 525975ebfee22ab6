"""What a person can do: verbs that change the session, applied in one place.

In: a session, and the arguments of a verb.
Out: the session, changed; long work goes to the worker.
Imports: `app.editor`, and the rooms that do the work.
"""

from app.editor.actions import (
    editing as editing,
    exporting as exporting,
    files as files,
    guiding as guiding,
    playback as playback,
    posing as posing,
    saving as saving,
    tracking as tracking,
    upkeep as upkeep,
    viewing as viewing,
)
from app.editor.actions.body import (
    cutting as cutting,
    material as material,
    rebuilding as rebuilding,
)
from app.editor.actions.posing.moving import (
    drafting as drafting,
    giving as giving,
    placing as placing,
)
from app.editor.actions.timing import (
    cycles as cycles,
    keys as keys,
    springs as springs,
    timeline_pointing as timeline_pointing,
    tracks as tracks,
)
from app.editor.actions.viewing import (
    OverlayName as OverlayName,
    answer as answer,
    browse as browse,
    choose as choose,
    close_dialog as close_dialog,
    dismiss as dismiss,
    show_dialog as show_dialog,
    use_own_dialogs as use_own_dialogs,
)
