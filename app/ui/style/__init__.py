"""The look of the window: themes, and the widgets that all panels share.

In: a theme and a scale.
Out: a `Look`, and widgets.
Imports: Dear ImGui.
"""

from app.ui.style.drawing import (
    draw_centred_text as draw_centred_text,
    draw_knob as draw_knob,
    draw_tag as draw_tag,
    outline_strokes as outline_strokes,
    tag_size as tag_size,
)
from app.ui.style.sliders import (
    FIELD as FIELD,
    Scale as Scale,
    number_field as number_field,
    slider as slider,
    slider_track as slider_track,
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
    colour_u32 as colour_u32,
    interface_scale as interface_scale,
    load_fonts as load_fonts,
    pixel_density as pixel_density,
    rgb as rgb,
    with_alpha as with_alpha,
)
from app.ui.style.widgets import (
    FILL as FILL,
    LABEL_WIDTH as LABEL_WIDTH,
    POSE_PAYLOAD as POSE_PAYLOAD,
    TOAST as TOAST,
    align_right as align_right,
    begin_tooltip as begin_tooltip,
    bold_text as bold_text,
    colour_field as colour_field,
    draw_tooltip as draw_tooltip,
    heading as heading,
    icon_button as icon_button,
    is_hovered_or_held as is_hovered_or_held,
    is_pressed as is_pressed,
    label as label,
    main_button as main_button,
    name_popup as name_popup,
    option_buttons as option_buttons,
    progress_bar as progress_bar,
    push_text_size as push_text_size,
    shorten_text as shorten_text,
    show_picture as show_picture,
    small_text as small_text,
    split_line as split_line,
    text_button as text_button,
)
