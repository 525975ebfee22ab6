"""How the window looks: themes, and the few widgets that every panel is made of.

In: a theme and a scale.
Out: a `Look`, and widgets.
Imports: Dear ImGui.
"""

from app.ui.style.sliders import FIELD, Scale, number, slider, track
from app.ui.style.theme import (
    CHOSEN,
    FONT_SIZE,
    LARGE,
    PALETTES,
    SMALL,
    TITLE,
    Look,
    Palette,
    apply_theme,
    ink,
    interface_scale,
    load_fonts,
)
from app.ui.style.widgets import (
    FILL,
    POSE_PAYLOAD,
    TOAST,
    at_end,
    begin_tip,
    heading,
    icon_button,
    label,
    main_button,
    segments,
    shortened,
    show_picture,
    small,
    tip,
)

__all__ = [
    "CHOSEN",
    "FIELD",
    "FILL",
    "FONT_SIZE",
    "LARGE",
    "PALETTES",
    "POSE_PAYLOAD",
    "SMALL",
    "TITLE",
    "TOAST",
    "Look",
    "Palette",
    "Scale",
    "apply_theme",
    "at_end",
    "begin_tip",
    "heading",
    "icon_button",
    "ink",
    "interface_scale",
    "label",
    "load_fonts",
    "main_button",
    "number",
    "segments",
    "shortened",
    "show_picture",
    "slider",
    "small",
    "tip",
    "track",
]
