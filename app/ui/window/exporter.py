"""Draws an export in the window's own OpenGL context, between the window's frames."""

from collections.abc import Generator
from contextlib import ExitStack

from app.editor import ExportRun, Session
from app.editor.actions import exporting
from app.export import export, painter
from app.render import Renderer

BUDGET = 0.02  # seconds of each frame of the window


class Exporter:
    """Owner of what an export that is under way draws with.

    Parameters
    ----------
    renderer : Renderer
        Of the window.
    """

    def __init__(self, renderer: Renderer) -> None:
        self._context = renderer.programs.context
        self._owned = ExitStack()
        self._plan: object = None
        self._steps: Generator[int] | None = None

    def go_on(self, session: Session) -> None:
        """Draw some frames of the session's export; end one that was cancelled."""
        run = session.export
        if run is None or run.plan is not self._plan:
            self.release()
        if run is None:
            return
        try:
            self._draw(session, run)
        except Exception as error:  # noqa: BLE001 - reported, and the window lives on
            self.release()
            exporting.fail(session, error)

    def release(self) -> None:
        """End the export that is under way; whole frames stay."""
        if self._steps is not None:
            self._steps.close()
        self._steps = self._plan = None
        self._owned.close()

    def _draw(self, session: Session, run: ExportRun) -> None:
        if self._steps is None:
            draw = self._owned.enter_context(
                painter(self._context, run.document, run.picture, run.poses, run.plan)
            )
            self._plan, self._steps = run.plan, export(run.plan, draw)
        begun = session.clock()
        while True:
            done = next(self._steps, None)
            if done is None:
                self.release()
                exporting.finish(session, run)
                return
            exporting.advance(session, run, done)
            if session.clock() - begun >= BUDGET or session.export is None:
                return
            run = session.export
