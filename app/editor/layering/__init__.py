"""What a person does with layers: choosing, ordering, hiding, replacing, joining them.

In: a session, and the ids of layers.
Out: other layers, or others in another order; which of them is posed.
Imports: `app.editor`, `app.document`, `app.motion`, `app.solving`, `app.storage`.
"""

from app.editor.layering.arranging import (
    ask_name as ask_name,
    blend as blend,
    clip as clip,
    duplicate as duplicate,
    fade as fade,
    fade_group as fade_group,
    group as group,
    group_together as group_together,
    is_at as is_at,
    layer_at as layer_at,
    list_active as list_active,
    lock as lock,
    move as move,
    move_beside as move_beside,
    refer as refer,
    rename as rename,
    rename_group as rename_group,
    show as show,
    show_group as show_group,
    switch_here as switch_here,
    take_in as take_in,
    ungroup as ungroup,
    unswitch_here as unswitch_here,
)
from app.editor.layering.choosing import (
    choose as choose,
    choose_all as choose_all,
    choose_too as choose_too,
    choose_up_to as choose_up_to,
    look_at_alone as look_at_alone,
    tidy_rows as tidy_rows,
    toggle as toggle,
)
from app.editor.layering.filming import (
    change_camera_key as change_camera_key,
    delete_camera_key as delete_camera_key,
    fade_here as fade_here,
    key_camera as key_camera,
    look_through as look_through,
    move_here as move_here,
    place_here as place_here,
    unfade_here as unfade_here,
    unmove_here as unmove_here,
    unplace_here as unplace_here,
)
from app.editor.layering.hanging import (
    hand_over as hand_over,
    hang as hang,
    hang_together as hang_together,
    hangs_on as hangs_on,
    let_hang as let_hang,
    remove as remove,
    take_back_joint as take_back_joint,
    turn_with as turn_with,
)
from app.editor.layering.pictures import (
    add as add,
    ask as ask,
    ask_replace as ask_replace,
    drop as drop,
    point_at as point_at,
    replace_picture as replace_picture,
    stand_still as stand_still,
    stand_up as stand_up,
)
from app.editor.layering.turns import (
    decline as decline,
    dissolve as dissolve,
    form as form,
    join as join,
    leave as leave,
    rename_choice as rename_choice,
    show_here as show_here,
)
