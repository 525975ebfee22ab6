"""A first animation in five steps: which one comes next is told by the document and the session."""

from dataclasses import replace

from app.document import (
    Document,
    FrameRange,
    Layer,
    handle_commands,
    key_commands,
    scene_commands,
)
from app.editor.action import do
from app.editor.actions import files, saving
from app.editor.failures import ask_worker
from app.editor.project import Project
from app.editor.session import Guide, GuideStep, Session
from app.editor.work import Kind
from app.storage import load_project, sample_images
from engine.maps import HarmonicMap

STEPS: tuple[GuideStep, ...] = ("handle", "time", "pose", "play", "export")
FORMAT = "gif"
SAMPLE = "giraffe.lissom"
LED = "nose"  # the handle of the sample that the person makes anew
HELD = ("withers", "chest", "rump", "hoof")  # ends of the names of those that stay
LAST, SIZE = 48, (480, 480)  # of the sample's loop, and of its GIF in pixels
HOLDS_AND_MOVES = 2  # handles that an own drawing needs
OPENING = Kind("Opening the giraffe", "The giraffe cannot be opened")


def begin(session: Session) -> None:
    """Open a copy of the giraffe without motion, and lead the person through making it bow."""

    def done(read: tuple[files.Opened, Guide]) -> None:
        saving.unless_unsaved(session, do(show, *read))

    ask_worker(session, OPENING, _read, done)


def begin_with_own(session: Session) -> None:
    """Ask for a drawing, and lead the person through its first animation."""
    session.ask_file("Open a drawing", files.OPENABLE, lambda path: do(files.open_file, path))
    session.guide = Guide()


def show(session: Session, opened: files.Opened, guide: Guide) -> None:
    """Make the giraffe the project of the window, and begin."""
    files.show(session, sample_images() / SAMPLE, opened)
    session.guide = _attached(session, guide)


def leave(session: Session) -> None:
    """End the guide; what was made stays."""
    session.guide = None


def follow(session: Session) -> None:
    """See what the person has done, and go on or back to the step that is next; once a frame."""
    guide, project = session.guide, session.project
    if guide is None:
        return
    if guide.project is None:
        # Nothing was chosen, or what was cannot be opened.
        is_given_up = project is None and session.dialog is None and not session.jobs.kinds
        session.guide = None if is_given_up else _attached(session, guide)
    elif guide.project is not project:
        session.guide = None
    elif session.pointer is None and project.timing.gesture is None:
        # What the hand is at is not to be disturbed by what comes next.
        session.guide = _advanced(session, project, guide)


def is_led(session: Session) -> bool:
    """Tell whether a guide is shown."""
    return session.guide is not None and session.guide.project is not None


def is_posed(layer: Layer) -> bool:
    """Tell whether the first pose is another than the one in which the picture was drawn."""
    rest = HarmonicMap.identity(layer.domain.cage, layer.domain.holes)
    return not layer.map_of(layer.keys[0].pose).is_same(rest)


def _read() -> tuple[files.Opened, Guide]:
    document = load_project(sample_images() / SAMPLE)
    layer = document.layers[0]
    led = next(handle for handle in layer.handles if handle.name == LED)
    goal = next(
        target.position
        for key in layer.keys[1:]
        if (target := key.pose.targets.get(led.id)) and target.position is not None
    )
    opened = files.decoded(_at_rest(document), SAMPLE)
    return opened, Guide(aim=led.position, goal=goal)


def _at_rest(document: Document) -> Document:
    """Return a document with its first key only, and only those handles that hold still."""
    layer = document.layers[0]
    free = [handle.id for handle in layer.handles if not handle.name.endswith(HELD)]
    for command in (
        key_commands.delete_keys(layer.id, [key.frame for key in layer.keys[1:]]),
        handle_commands.remove_handles(layer.id, free),
        scene_commands.set_frames(FrameRange(0, LAST)),
        scene_commands.set_export(replace(document.export.in_format(FORMAT), size=SIZE)),
    ):
        document = command(document)
    return document


def _attached(session: Session, guide: Guide) -> Guide:
    """Return a guide through the project that is open, if there is one by now."""
    project = session.project
    if project is None:
        return guide
    return replace(
        guide, project=project, handles=_handles(project.document), exported=session.exported
    )


def _handles(document: Document) -> frozenset[tuple[int, int]]:
    return frozenset((layer.id, handle.id) for layer in document.layers for handle in layer.handles)


def _advanced(session: Session, project: Project, guide: Guide) -> Guide:
    """Return a guide at the step that is next; the same one where nothing has changed."""
    if guide.step == "done":
        return guide
    moves = any(map(_moves, project.document.layers))
    has_played = moves and (guide.has_played or project.playhead.since is not None)
    step = _next_step(project, guide, moves=moves, has_played=has_played)
    exported = session.exported
    if exported is not guide.exported and guide.step == step == "export":
        step = "done" if exported is not None and exported.format == FORMAT else step
    if (step, has_played, exported) == (guide.step, guide.has_played, guide.exported):
        return guide
    return replace(guide, step=step, has_played=has_played, exported=exported)


def _next_step(project: Project, guide: Guide, *, moves: bool, has_played: bool) -> GuideStep:
    if moves:
        return "export" if has_played else "play"
    new = _handles(project.document) - guide.handles
    wanted = HOLDS_AND_MOVES if guide.aim is None else 1
    if len(new) < wanted and not any(map(is_posed, project.document.layers)):
        return "handle"
    playhead, first = project.playhead, project.layer.keys[0].frame
    return "time" if playhead.since is not None or playhead.frame == first else "pose"


def _moves(layer: Layer) -> bool:
    """Tell whether a layer has poses of its own to go between, or a track that moves a handle."""
    if any(len(track.keys) > 1 for track in layer.tracks):
        return True
    first = layer.map_of(layer.keys[0].pose)
    return any(not layer.map_of(key.pose).is_same(first) for key in layer.keys[1:])
