"""Draws an export in the window's own OpenGL context, between the window's frames."""

from collections.abc import Generator

from app.editor import ExportRun, Session
from app.editor.actions.project_files import exporting
from app.export import FrameRenderer, MeshExport
from app.export_formats import EXPORT_FORMATS
from app.render import Renderer

BUDGET = 0.02  # seconds per frame of the window


class Exporter:
    """Owner of the renderer and the generator of the running export."""

    def __init__(self, renderer: Renderer) -> None:
        self._context = renderer.programs.context
        self._plan: object = None
        self._maker: FrameRenderer | MeshExport | None = None
        self._steps: Generator[int] | None = None

    def step(self, session: Session) -> None:
        """Draw some frames of the session's export. Release the export if it was cancelled."""
        run = session.export.run
        if run is None or run.plan is not self._plan:
            self.release()
        if run is None:
            return
        try:
            self._draw(session, run)
        except Exception as error:  # noqa: BLE001 - reported, and the window lives on
            self.release()
            exporting.report_failed_export(session, error)

    def release(self) -> None:
        """End the running export. Complete frames stay."""
        if self._steps is not None:
            self._steps.close()
        if isinstance(self._maker, FrameRenderer):
            self._maker.release()
        self._steps = self._maker = self._plan = None

    def _draw(self, session: Session, run: ExportRun) -> None:
        if self._steps is None or self._maker is None:
            self._plan = run.plan
            given = run.document, run.pictures, run.evaluator, run.plan
            is_drawn = EXPORT_FORMATS[run.plan.format].is_drawn
            self._maker = FrameRenderer(self._context, *given) if is_drawn else MeshExport(*given)
            self._steps = self._maker.run(waits=False, cancellation=session.export.cancellation)
        begun = session.clock()
        drawn = run.done
        for done in self._steps:
            exporting.update_export_progress(session, run, done)
            # No new frame is ready: the other threads are still at work.
            if done == drawn or session.clock() - begun >= BUDGET:
                return
            drawn = done
        notices = self._maker.notices
        self.release()
        exporting.finish_export(session, run, notices)
