"""Actions of the person: verbs that change the session, applied in one place.

In: a session, and the arguments of a verb.
Out: the changed session; long work goes to the worker.
Imports: `app.editor`, and the rooms that do the work.
"""

from app.editor.actions import (
    editing as editing,
    exporting as exporting,
    files as files,
    playback as playback,
    posing as posing,
    saving as saving,
    tracking as tracking,
    tutorials as tutorials,
    upkeep as upkeep,
    viewing as viewing,
)
from app.editor.actions.layer_setup import (
    cut_out_editing as cut_out_editing,
    resolving as resolving,
    stiffness_editing as stiffness_editing,
)
from app.editor.actions.posing.motion_presets import (
    apply_motion as apply_motion,
    joint_placement as joint_placement,
    preset_setup as preset_setup,
)
from app.editor.actions.timing import (
    cycles as cycles,
    keys as keys,
    springs as springs,
    timeline_drag as timeline_drag,
    tracks as tracks,
)
from app.editor.actions.viewing import (
    OverlayName as OverlayName,
    answer_dialog as answer_dialog,
    browse_files as browse_files,
    choose_file as choose_file,
    close_dialog as close_dialog,
    dismiss_toast as dismiss_toast,
    show_dialog as show_dialog,
    use_own_file_browser as use_own_file_browser,
)
