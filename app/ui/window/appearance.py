"""The fonts and the theme of the window."""

from imgui_bundle import ImVec2, hello_imgui, imgui, implot

from app.editor import Session
from app.ui.style.theme import FONT_SIZE, PALETTES, Look, apply_theme, interface_scale, load_fonts
from app.ui.window.guard import allow_recovery


class Appearance:
    """Sets up Dear ImGui, and keeps its style as the preferences say."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._bold: imgui.ImFont | None = None
        self._themed: tuple[str, float] | None = None

    def begin_frame(self) -> None:
        """Apply the theme if the preferences or the screen have changed."""
        if self._themed != self._theme:
            self.apply_theme()

    def look(self, places: dict[str, tuple[ImVec2, ImVec2]]) -> Look:
        """Return the look of a frame; `places` collects rectangles of its items."""
        if self._bold is None:
            raise RuntimeError("the window has no fonts before its first frame")
        preferences = self._session.settings.preferences
        return Look(
            palette=PALETTES[preferences.theme],
            bold=self._bold,
            em=imgui.get_font_size() or FONT_SIZE * interface_scale(preferences.scale),
            places=places,
        )

    def load_fonts(self) -> None:
        self._bold = load_fonts()

    def configure(self) -> None:
        io = imgui.get_io()
        io.config_flags |= imgui.ConfigFlags_.docking_enable
        io.config_windows_move_from_title_bar_only = True
        # One click on a number edits it. Then typed keys are input and not shortcuts.
        io.config_drag_click_to_input_text = True
        allow_recovery()
        implot.create_context()

    def apply_theme(self) -> None:
        preferences = self._session.settings.preferences
        self._themed = self._theme
        palette = PALETTES[preferences.theme]
        apply_theme(palette, preferences.scale)
        hello_imgui.get_runner_params().imgui_window_params.background_color = palette.panel

    @property
    def _theme(self) -> tuple[str, float]:
        """The inputs of the style: the theme, and the interface scale on this screen."""
        preferences = self._session.settings.preferences
        return preferences.theme, interface_scale(preferences.scale)
