"""Jobs for values that are measured of the document, and for pictures of its layers."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import TypeVar

from app.editor.error_reports import report_failure
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.derived import Derived
from app.editor.work.jobs import Job, JobKind
from app.motion import (
    Evaluator,
    LayerStages,
    MotionPaths,
    extent_key,
    find_parent_motion,
    measure_extent,
    trace_paths,
)
from app.reports import CorrectedSample, measure_curves
from app.storage import cut_picture, shrink_picture
from app.texts import _

SMALL_SIDE = 96  # pixels of a picture in the list of layers
CUTTING = JobKind(_("Cutting out"), _("The picture cannot be cut out with these settings"))
# It takes a few milliseconds.
SHRINKING = JobKind(_("Thumbnails"), _("A layer's thumbnail cannot be drawn"), "hand")
TRACING = JobKind(_("Motion paths"), _("The paths of the handles cannot be traced"))
MEASURING = JobKind(_("Measuring"), _("The distortion could not be measured"))
SPANNING = JobKind(_("Measuring the motion"), _("The extent of the motion could not be measured"))

Source = TypeVar("Source")
Value = TypeVar("Value")


def asks_extent(session: Session, project: Project) -> bool:
    """Return whether the extent of the motion is awaited."""
    return session.export.frame_box is not None or project.viewport.awaits_extent


def cut_out_jobs(session: Session, project: Project) -> Iterator[Job]:
    """Yield jobs for new cut-outs, and for the small pictures of the list of layers."""
    for layer in project.document.layers:
        runtime, cut_out = project.runtimes.layers[layer.id], layer.cut_out
        cut = partial(cut_picture, runtime.picture, cut_out)
        yield from _derive(session, CUTTING, runtime.cut, cut_out, cut)
        whole = runtime.cut.value
        small = partial(shrink_picture, whole.texture, SMALL_SIDE)
        yield from _derive(session, SHRINKING, runtime.small, whole, small)


def motion_path_jobs(session: Session, project: Project) -> Iterator[Job]:
    """Yield the job for motion paths of the active layer's handles, while some are shown."""
    clip, paths = project.clip, project.measured.paths
    if session.display.overlays.paths and project.selection.handles:
        document, known, siblings = project.document, paths.value, project.samplers
        sibling = project.layer_runtime.store.sampler

        def trace() -> MotionPaths:
            carried = find_parent_motion(document, clip.layer.id, siblings)
            return trace_paths(clip, known, sibling, carried)

        yield from _derive(session, TRACING, paths, clip, trace)


def distortion_jobs(session: Session, project: Project) -> Iterator[Job]:
    """Yield jobs that measure the distortion of the in-betweens."""
    comparison, wanted = project.layer_runtime.comparison, [(project.clip, project.measured.curves)]
    if comparison is not None:
        wanted.append((comparison.clip(project.document), project.measured.comparison_curves))
    store, corrected = project.layer_runtime.store, project.layer_runtime.corrected
    for clip, curves in wanted:
        inbetweens = store.prepared(clip)
        own = corrected if corrected is not None and corrected.corrects(clip) else None
        if inbetweens and (own is None or own.is_whole):
            at = None
            if own is not None and store.sampler is not None:
                at = CorrectedSample(own, store.sampler)
            measure = partial(measure_curves, clip, inbetweens, at)
            yield from _derive(session, MEASURING, curves, clip, measure)


def extent_jobs(session: Session, project: Project) -> Iterator[Job]:
    """Yield the job that measures the extent of the motion, once all in-betweens exist."""
    document, extent, source = (
        project.document,
        project.measured.extent,
        extent_key(project.document),
    )
    clips = project.clips
    if extent.follows(source) or not all(each.store.has(clip) for clip, each in clips):
        return
    if not all(each.corrected is None or each.corrected.is_whole for _, each in clips):
        return
    stages = {
        layer: LayerStages(layer_id=layer, store=each.store.snapshot(), corrected=each.corrected)
        for layer, each in project.runtimes.layers.items()
    }
    evaluator = Evaluator(layers=stages, transforms=project.measured.parent_transforms.value)
    span = partial(measure_extent, document, evaluator)
    yield from _derive(session, SPANNING, extent, source, span)


def _derive(
    session: Session,
    kind: JobKind,
    into: Derived[Source, Value],
    source: Source,
    work: Callable[[], Value],
) -> Iterator[Job]:
    """Yield the job for the value of a source, unless the value exists or has failed."""
    if not (into.follows(source) or into.has_failed(source)):
        yield make_job(session, kind, work, partial(into.set, source), partial(into.fail, source))


def make_job(
    session: Session,
    kind: JobKind,
    work: Callable[[], Value],
    done: Callable[[Value], None],
    fail: Callable[[], None],
) -> Job:
    def failed(error: Exception) -> None:
        fail()
        report_failure(session, kind.complaint, error)

    return Job(kind=kind, work=work, done=done, failed=failed)
