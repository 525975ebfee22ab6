"""Jobs that decode footage: the shown pictures first, then those that the playhead will reach."""

from collections.abc import Iterator
from functools import partial
from math import floor, log2

from app.document import Footage, Layer, footage_picture_at
from app.editor.actions import playback
from app.editor.error_reports import as_sentence
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import Job, JobKind
from app.errors import LissomError
from app.storage import PackedPictures
from app.texts import _, message_of

DECODING = JobKind(_("Reading footage"), _("The footage cannot be shown"), "footage")
SMALLEST_SCALE = 1 / 64
# Frames whose pictures are decoded ahead, and by how many their range moves.
MOST_AHEAD, STRETCH = 2000, 500


@with_project
def decode_footage(session: Session, project: Project) -> None:
    """Queue a job for the most urgent pictures of footage that the window lacks."""
    layers = [layer for layer in project.document.layers if layer.footage is not None]
    if not layers or DECODING in session.jobs.kinds:
        return
    project.footage.keep_only(
        [layer.footage for layer in layers if layer.footage], {layer.id for layer in layers}
    )
    reduction = _reduction(session, project)
    for layer, numbers, is_ahead in _wanted(session, project, layers):
        footage = layer.footage
        if footage is None or footage in project.footage.errors:
            continue
        needed = numbers[: project.footage.room(footage)] if is_ahead else numbers
        lacking = [each for each in needed if project.footage.lacks(footage, each, reduction)]
        if lacking:
            session.jobs.put(_job(session, project, footage, lacking, needed, reduction))
            return


def _wanted(
    session: Session, project: Project, layers: list[Layer]
) -> Iterator[tuple[Layer, list[int], bool]]:
    """Yield the shown picture of each layer, then those of other frames, the nearest ahead first.

    The flag says whether the pictures are decoded ahead.
    """
    document, frame = project.document, playback.current_frame(session, project)
    for layer in layers:
        shown = footage_picture_at(document, layer, frame)
        yield layer, [] if shown is None else [shown], False
    if not session.settings.prepares_ahead:
        return
    first, last = document.played_frames.first, document.played_frames.last
    here = min(max(int(frame), first), last)
    if last - first >= MOST_AHEAD:
        first = max(first, here // STRETCH * STRETCH)
        last = min(last, first + MOST_AHEAD - 1)
    for layer in layers:
        numbers = _all_numbers(project, layer, first, last)
        yield layer, [*dict.fromkeys([*numbers[here - first :], *numbers[: here - first]])], True


def _all_numbers(project: Project, layer: Layer, first: int, last: int) -> list[int]:
    """Return the pictures of all frames of a range; found again only after a change of its time."""
    document = project.document
    source = layer, document.fps, document.frames, document.loop, first, last
    known = project.footage.numbers.get(layer.id)
    if known is None or known[0] != source:
        found = [footage_picture_at(document, layer, frame) for frame in range(first, last + 1)]
        known = source, [number for number in found if number is not None]
        project.footage.note_numbers(layer.id, *known)
    return known[1]


def _reduction(session: Session, project: Project) -> int:
    """Return the power of two by which pictures shrink while each screen pixel has one."""
    scale = project.view_on(session.display.screen).scale
    return 1 << max(0, floor(-log2(max(scale, SMALLEST_SCALE))))


def _job(
    session: Session,
    project: Project,
    footage: Footage,
    lacking: list[int],
    needed: list[int],
    reduction: int,
) -> Job:
    cache = project.footage

    def done(pictures: PackedPictures) -> None:
        cache.add(footage, pictures, frozenset(needed))

    def failed(error: Exception) -> None:
        if not isinstance(error, LissomError):
            error = LissomError(_("{name} cannot be read").format(name=footage.name))
        cache.note_error(footage, lacking[0], error)
        session.notices.show(as_sentence(message_of(error)), tone="error", topic=footage.name)

    decode = cache.decoder.decode
    work = partial(decode, footage, lacking, reduction, cache.generation)
    return Job(kind=DECODING, work=work, done=done, failed=failed)
