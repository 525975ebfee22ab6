"""How the window looks: themes, and the few widgets that every panel is made of.

In: a theme and a scale.
Out: a `Look`, and widgets.
Imports: Dear ImGui.
"""

from app.ui.style.drawing import (
    draw_knob as draw_knob,
    outlined as outlined,
    tag_size as tag_size,
    write_in as write_in,
    write_tag as write_tag,
)
from app.ui.style.sliders import (
    FIELD as FIELD,
    Scale as Scale,
    number as number,
    slider as slider,
    track as track,
)
from app.ui.style.theme import (
    CHOSEN as CHOSEN,
    FONT_SIZE as FONT_SIZE,
    LARGE as LARGE,
    PALETTES as PALETTES,
    SMALL as SMALL,
    TITLE as TITLE,
    Look as Look,
    Palette as Palette,
    apply_theme as apply_theme,
    density as density,
    faint as faint,
    ink as ink,
    interface_scale as interface_scale,
    load_fonts as load_fonts,
    rgb as rgb,
)
from app.ui.style.widgets import (
    FILL as FILL,
    LABEL_WIDTH as LABEL_WIDTH,
    POSE_PAYLOAD as POSE_PAYLOAD,
    TOAST as TOAST,
    at_end as at_end,
    begin_tip as begin_tip,
    beside as beside,
    bold as bold,
    colour_field as colour_field,
    heading as heading,
    icon_button as icon_button,
    in_hand as in_hand,
    is_pressed as is_pressed,
    label as label,
    main_button as main_button,
    name_popup as name_popup,
    progress as progress,
    segments as segments,
    shortened as shortened,
    show_picture as show_picture,
    sized as sized,
    small as small,
    text_button as text_button,
    tip as tip,
)
