"""The two themes: colours, spacing, rounding and fonts, given to Dear ImGui in one place."""

from dataclasses import dataclass, field

from imgui_bundle import ImVec2, ImVec4, hello_imgui, icons_fontawesome_6 as icons, imgui

FONT_SIZE = 15.0  # pixels at scale 1
SMALL, LARGE, TITLE = 0.87, 1.2, 2.1  # font sizes, relative to the text's
CHOSEN = 0.18  # opacity of the accent colour behind the selected row of a list


def rgb(code: str) -> ImVec4:
    """Return the colour written "rrggbb" or "#rrggbb"."""
    red, green, blue = (level / 255 for level in bytes.fromhex(code.removeprefix("#")))
    return ImVec4(red, green, blue, 1.0)


def with_alpha(colour: ImVec4, alpha: float) -> ImVec4:
    return ImVec4(colour.x, colour.y, colour.z, alpha)


def colour_u32(colour: ImVec4, alpha: float = 1.0) -> int:
    """Return a colour as draw lists need it. `alpha` multiplies its opacity."""
    return imgui.color_convert_float4_to_u32(ImVec4(colour.x, colour.y, colour.z, colour.w * alpha))


def icon_glyph(name: str) -> str:
    """Return a Font Awesome icon by its name, such as "ANGLES_LEFT"."""
    glyph: str = getattr(icons, f"ICON_FA_{name}")
    return glyph


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Palette:
    """The colours of a theme, named by their use.

    Text colours have a contrast of 4.5 or more with all surfaces and with selected rows.
    """

    is_dark: bool
    desk: ImVec4  # behind all panels, and around the drawing
    panel: ImVec4
    raised: ImVec4  # fields and buttons
    hovered: ImVec4
    pressed: ImVec4
    line: ImVec4
    text: ImVec4
    dim: ImVec4
    accent: ImVec4
    on_accent: ImVec4
    good: ImVec4
    warning: ImVec4  # also for a pose that is not in a key
    danger: ImVec4
    anchor: ImVec4
    paper: ImVec4  # the two squares of the checker
    check: ImVec4


DARK = Palette(
    is_dark=True,
    desk=rgb("17181c"),
    panel=rgb("1f2126"),
    raised=rgb("2b2e35"),
    hovered=rgb("33363f"),
    pressed=rgb("3a3e47"),
    line=rgb("33363e"),
    text=rgb("e3e5ea"),
    dim=rgb("a4a9b6"),
    accent=rgb("93a3ff"),
    on_accent=rgb("10121c"),
    good=rgb("5fc796"),
    warning=rgb("f2a65a"),
    danger=rgb("ff8580"),
    anchor=rgb("3fd0e6"),
    paper=rgb("2a2c32"),
    check=rgb("25272d"),
)
LIGHT = Palette(
    is_dark=False,
    desk=rgb("e6e7eb"),
    panel=rgb("f8f8fa"),
    raised=rgb("e9eaef"),
    hovered=rgb("e0e2e9"),
    pressed=rgb("d6d9e2"),
    line=rgb("d5d7de"),
    text=rgb("23252b"),
    dim=rgb("5a5e6b"),
    accent=rgb("404ed2"),
    on_accent=rgb("ffffff"),
    good=rgb("036d42"),
    warning=rgb("944a00"),
    danger=rgb("b62427"),
    anchor=rgb("02687b"),
    paper=rgb("ffffff"),
    check=rgb("f1f1f4"),
)
PALETTES = {"dark": DARK, "light": LIGHT}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Look:
    """Colours, fonts and the em size that panels draw with."""

    palette: Palette
    bold: imgui.ImFont
    em: float  # pixels
    # Upper left and lower right corners of this frame's items that the tutorial can point at.
    places: dict[str, tuple[ImVec2, ImVec2]] = field(default_factory=dict)

    def note_place(self, name: str) -> None:
        """Record the rectangle of the last item, for the tutorial."""
        self.places[name] = imgui.get_item_rect_min(), imgui.get_item_rect_max()


def interface_scale(scale: float) -> float:
    """Return how many pixels of the window one pixel of the design takes.

    Parameters
    ----------
    scale : float
        The person's choice. It multiplies the system's own scale.
    """
    return scale * imgui.get_style().font_scale_dpi


def pixel_density() -> float:
    """Return how many pixels of a framebuffer one pixel of the window has."""
    return imgui.get_io().display_framebuffer_scale.x or 1.0


def load_fonts() -> imgui.ImFont:
    """Load the text font (with icons) as the default. Return the bold font."""
    _load_with_icons("Roboto/Roboto-Regular.ttf")
    return _load_with_icons("Roboto/Roboto-Bold.ttf")


def _load_with_icons(name: str) -> imgui.ImFont:
    font = hello_imgui.load_font(f"fonts/{name}", FONT_SIZE)
    icons = hello_imgui.FontLoadingParams(merge_to_last_font=True)
    hello_imgui.load_font("fonts/Font_Awesome_6_Free-Solid-900.otf", 0.9 * FONT_SIZE, icons)
    # Last, for glyphs that the other fonts lack: the key symbols of a Mac.
    hello_imgui.load_font("fonts/Inconsolata-Medium.ttf", FONT_SIZE, icons)
    return font


def apply_theme(palette: Palette, scale: float) -> None:
    """Set Dear ImGui's colours from the theme, and its sizes, multiplied by `scale`."""
    style = imgui.get_style()
    dpi = style.font_scale_dpi
    fresh = imgui.Style()
    # Reset all sizes first, because scaling multiplies the present ones.
    for name in dir(fresh):
        value = getattr(fresh, name)
        if not name.startswith(("_", "font")) and isinstance(value, (bool, int, float, ImVec2)):
            setattr(style, name, value)
    for name, size in _SIZES.items():
        setattr(style, name, ImVec2(*size) if isinstance(size, tuple) else size)
    style._main_scale = 1.0  # noqa: SLF001 - scaling multiplies it, too; it has no public name
    style.scale_all_sizes(scale * dpi)
    style.font_size_base = FONT_SIZE
    style.window_menu_button_position = imgui.Dir.none
    style.font_scale_main = scale
    _colour(style, palette)


_SIZES: dict[str, float | tuple[float, float]] = {
    "window_padding": (12, 10),
    "window_rounding": 0,
    "window_border_size": 0,
    "child_rounding": 8,
    "child_border_size": 1,
    "popup_rounding": 8,
    "popup_border_size": 1,
    "frame_padding": (9, 5),
    "frame_rounding": 6,
    "frame_border_size": 0,
    "item_spacing": (8, 7),
    "item_inner_spacing": (7, 5),
    "cell_padding": (6, 4),
    "indent_spacing": 16,
    "scrollbar_size": 11,
    "scrollbar_rounding": 6,
    "grab_min_size": 11,
    "grab_rounding": 6,
    "tab_rounding": 6,
    "tab_border_size": 0,
    "tab_bar_border_size": 1,
    "tab_bar_overline_size": 0,
    "separator_size": 1,
    "separator_text_border_size": 1,
    "separator_text_padding": (0, 6),
    "docking_separator_size": 2,
    "menu_item_rounding": 5,
    "selectable_rounding": 5,
    "disabled_alpha": 0.42,
}


def _colour(style: imgui.Style, palette: Palette) -> None:
    none = ImVec4(0, 0, 0, 0)
    colours = {
        "text": palette.text,
        "text_disabled": palette.dim,
        "window_bg": palette.panel,
        "child_bg": none,
        "popup_bg": palette.panel,
        "border": palette.line,
        "border_shadow": none,
        "frame_bg": palette.raised,
        "frame_bg_hovered": palette.hovered,
        "frame_bg_active": palette.pressed,
        "title_bg": palette.desk,
        "title_bg_active": palette.desk,
        "title_bg_collapsed": palette.desk,
        "menu_bar_bg": palette.desk,
        "scrollbar_bg": none,
        "scrollbar_grab": palette.hovered,
        "scrollbar_grab_hovered": palette.pressed,
        "scrollbar_grab_active": palette.dim,
        "check_mark": palette.accent,
        "checkbox_selected_bg": palette.raised,
        "slider_grab": palette.accent,
        "slider_grab_active": palette.accent,
        "button": palette.raised,
        "button_hovered": palette.hovered,
        "button_active": palette.pressed,
        "header": with_alpha(palette.accent, CHOSEN),
        "header_hovered": palette.hovered,
        "header_active": palette.pressed,
        "separator": palette.line,
        "separator_hovered": palette.accent,
        "separator_active": palette.accent,
        "resize_grip": none,
        "resize_grip_hovered": palette.hovered,
        "resize_grip_active": palette.accent,
        "input_text_cursor": palette.accent,
        "tab_hovered": palette.hovered,
        "tab": palette.desk,
        "tab_selected": palette.panel,
        "tab_selected_overline": palette.accent,
        "tab_dimmed": palette.desk,
        "tab_dimmed_selected": palette.panel,
        "tab_dimmed_selected_overline": none,
        "docking_preview": with_alpha(palette.accent, 0.4),
        "docking_empty_bg": palette.desk,
        "plot_lines": palette.accent,
        "plot_lines_hovered": palette.accent,
        # For progress bars, which have text on top.
        "plot_histogram": with_alpha(palette.accent, 0.4),
        "plot_histogram_hovered": palette.accent,
        "table_header_bg": palette.raised,
        "table_border_strong": palette.line,
        "table_border_light": palette.line,
        "table_row_bg": none,
        "table_row_bg_alt": none,
        "text_link": palette.accent,
        "text_selected_bg": with_alpha(palette.accent, 0.35),
        "tree_lines": palette.line,
        "drag_drop_target": palette.accent,
        "drag_drop_target_bg": with_alpha(palette.accent, 0.1),
        "unsaved_marker": palette.text,
        "nav_cursor": palette.accent,
        "nav_windowing_highlight": palette.accent,
        "nav_windowing_dim_bg": with_alpha(palette.desk, 0.5),
        "modal_window_dim_bg": with_alpha(rgb("000000"), 0.45),
    }
    for name, colour in colours.items():
        style.set_color_(imgui.Col_[name], colour)
