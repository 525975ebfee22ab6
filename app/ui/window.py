"""The window: the session, what is drawn with OpenGL, and the loop around them."""

from collections.abc import Callable
from pathlib import Path

import moderngl
from imgui_bundle import hello_imgui

from app.render.thumbnails import Thumbnail, Thumbnails
from app.session import Session
from app.ui.panel import Panel
from app.ui.shell import Shell


class Window:
    """Owner of the OpenGL objects of one window.

    Parameters
    ----------
    session : Session
    connect : callable
        Returns the OpenGL context, once ImGui has made the window's.
    """

    def __init__(self, session: Session, connect: Callable[[], moderngl.Context]) -> None:
        self.session = session
        self._connect = connect
        self._thumbnails: Thumbnails | None = None
        self._shell = Shell(session, self._panels(), self._thumbnail)

    def runner_params(self) -> hello_imgui.RunnerParams:
        """Return the parameters to run the window with."""
        params = self._shell.runner_params()
        calls = params.callbacks
        calls.enqueue_post_init(self._start)
        calls.pre_new_frame = hello_imgui.sequence_functions(self._begin_frame, calls.pre_new_frame)
        return params

    def textures(self) -> dict[int, moderngl.Texture]:
        """Return the textures that the panels show, by their OpenGL names."""
        if self._thumbnails is None:
            return {}
        return {texture.glo: texture for texture in self._thumbnails.textures()}

    def _panels(self) -> list[Panel]:
        return []

    def _start(self) -> None:
        context = self._connect()
        self._thumbnails = Thumbnails(context)

    def _begin_frame(self) -> None:
        if self._thumbnails is not None:
            self._thumbnails.begin_frame()

    def _thumbnail(self, path: Path) -> Thumbnail | None:
        return self._thumbnails.get(path) if self._thumbnails else None
