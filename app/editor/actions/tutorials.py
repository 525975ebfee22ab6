"""The samples, and the tutorial: a first animation in five steps.

Document and session decide the next step of the tutorial.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import NamedTuple

from app.document import (
    PRESETS,
    Document,
    FrameRange,
    Layer,
    channel_commands,
    handle_commands,
    pose_channel,
    scene_commands,
)
from app.editor.action import do
from app.editor.actions import editing
from app.editor.actions.action_spec import named_action, unless
from app.editor.actions.posing import handles
from app.editor.actions.project_files import files, saving
from app.editor.actions.project_files.saving import PROJECT
from app.editor.error_reports import run_job
from app.editor.project import Project
from app.editor.session import Session, TutorialStage, TutorialState
from app.editor.work.jobs import JobKind
from app.storage import load_project, sample_images
from app.texts import N_, _
from engine.maps import HarmonicMap

STEPS: tuple[TutorialStage, ...] = ("handle", "time", "pose", "play", "export")
FORMAT = "gif"
SAMPLE = "giraffe.lissom"
LED = "nose"  # the sample's handle that the person adds again
HELD = ("withers", "chest", "rump", "hoof")  # endings of the names of handles that stay
LAST, SIZE = 48, (480, 480)  # last frame of the sample's loop; size of its GIF in pixels
HOLDS_AND_MOVES = 2  # number of handles that the person's own drawing needs
OPENING = JobKind(_("Opening the giraffe"), _("The giraffe cannot be opened"))
# Short descriptions of the samples by their names, as long as a card has room for.
STORIES = {
    N_("Bar"): _("A bar to bend"),
    N_("Character"): _("Waves a hand"),
    N_("Dragon"): _("Nods and sweeps its tail"),
    N_("Friend"): _("Layers that wave and laugh"),
    N_("Giraffe"): _("Bends down and comes up"),
    N_("Octopus"): _("Arms that curl in a loop"),
    N_("Ring"): _("A hole that opens and closes"),
    N_("S"): _("A spine to curl or straighten"),
}


@named_action(_("Your first animation"), needs_project=False)
def begin_tutorial(session: Session) -> None:
    """Open a copy of the giraffe without motion, and guide the person to make it bow."""

    def done(read: tuple[files.OpenedFile, TutorialState]) -> None:
        saving.confirm_unsaved(session, do(install_tutorial, *read))

    run_job(session, OPENING, _read, done)


def begin_tutorial_with_own_drawing(session: Session) -> None:
    """Ask for a drawing, and guide the person through its first animation."""
    session.ask_file(_("Open a drawing"), files.OPENABLE, lambda path: do(files.open_file, path))
    session.tutorial.show(TutorialState())


def install_tutorial(session: Session, opened: files.OpenedFile, guide: TutorialState) -> None:
    """Open the giraffe in the window, and begin."""
    files.install_opened_file(session, sample_images() / SAMPLE, opened)
    session.tutorial.show(_attached(session, guide))


def is_tutorial_shown(session: Session) -> bool:
    return session.tutorial.state is not None and session.tutorial.state.project is not None


@named_action(
    _("End guide"),
    "Escape",
    why_disabled=unless(lambda session, _: is_tutorial_shown(session), _("No guide is open.")),
)
def end_tutorial(session: Session) -> None:
    """End the tutorial; the project stays."""
    session.tutorial.end()


def update_tutorial(session: Session) -> None:
    """Go on or back to the next step, depending on the document; once a frame."""
    guide, project = session.tutorial.state, session.project
    if guide is None:
        return
    if guide.project is None:
        # No file was chosen, or the file could not be opened.
        is_given_up = project is None and session.dialogs.current is None and not session.jobs.kinds
        if is_given_up:
            session.tutorial.end()
        else:
            session.tutorial.show(_attached(session, guide))
            if project is not None and guide.handle_place is None:
                _prepare_own_drawing(session, project)
    elif guide.project is not project:
        session.tutorial.end()
    elif session.tools.active_tool is None and project.timeline.gesture is None:
        # The next step must not disturb a drag.
        session.tutorial.show(_advanced(session, project, guide))


def _prepare_own_drawing(session: Session, project: Project) -> None:
    """Set a drawing up as the giraffe is: handles, a loop, an easing, and a GIF to export."""
    layer, document = project.layer, project.document
    if layer.still or len(layer.keys) > 1 or layer.handles:
        return
    handles.suggest_handles(session)
    longest = max(document.canvas)
    width, height = (max(round(side * min(SIZE[0] / longest, 1.0)), 1) for side in document.canvas)
    settings = replace(document.export.in_format(FORMAT), size=(width, height))
    start = {pose_channel(layer.id): frozenset({layer.keys[0].frame})}
    for command in (
        scene_commands.set_loop(loop=True),
        channel_commands.set_easing(start, PRESETS["in-out"]),
        scene_commands.set_export(settings),
    ):
        editing.edit_document(session, command)
    session.display.focus_panel("Handle")


def is_first_pose_changed(layer: Layer) -> bool:
    """Return whether the first pose differs from the drawing's pose."""
    rest = HarmonicMap.identity(layer.domain.cage, layer.domain.holes)
    return not layer.map_of(layer.keys[0].pose).is_same(rest)


def _read() -> tuple[files.OpenedFile, TutorialState]:
    document = load_project(sample_images() / SAMPLE)
    layer = document.layers[0]
    led = next(handle for handle in layer.handles if handle.name == LED)
    goal = next(
        target.position
        for key in layer.keys[1:]
        if (target := key.pose.targets.get(led.id)) and target.position is not None
    )
    opened = files.decode_project(_at_rest(document), SAMPLE)
    return opened, TutorialState(handle_place=led.position, target_place=goal)


def _at_rest(document: Document) -> Document:
    """Return a document with its first key only, and only the handles that hold still."""
    layer = document.layers[0]
    free = [handle.id for handle in layer.handles if not handle.name.endswith(HELD)]
    for command in (
        channel_commands.delete_keys(
            {pose_channel(layer.id): frozenset(key.frame for key in layer.keys[1:])}
        ),
        handle_commands.remove_handles(layer.id, free),
        scene_commands.set_frames(FrameRange(0, LAST)),
        scene_commands.set_export(replace(document.export.in_format(FORMAT), size=SIZE)),
    ):
        document = command(document)
    return document


def _attached(session: Session, guide: TutorialState) -> TutorialState:
    """Return a tutorial with the open project, if there is one by now."""
    project = session.project
    if project is None:
        return guide
    return replace(
        guide,
        project=project,
        handles=_handles(project.document),
        exported=session.export.completed,
    )


def _handles(document: Document) -> frozenset[tuple[int, int]]:
    return frozenset((layer.id, handle.id) for layer in document.layers for handle in layer.handles)


def _advanced(session: Session, project: Project, guide: TutorialState) -> TutorialState:
    """Return a tutorial at its next step; the same tutorial if nothing has changed."""
    if guide.stage == "done":
        return guide
    moves = any(map(_moves, project.document.layers))
    has_played = moves and (guide.has_played or project.timeline.playhead.since is not None)
    step = _next_step(project, guide, moves=moves, has_played=has_played)
    exported = session.export.completed
    if exported is not guide.exported and guide.stage == step == "export":
        step = "done" if exported is not None and exported.format == FORMAT else step
    if (step, has_played, exported) == (guide.stage, guide.has_played, guide.exported):
        return guide
    return replace(guide, stage=step, has_played=has_played, exported=exported)


def _next_step(
    project: Project, guide: TutorialState, *, moves: bool, has_played: bool
) -> TutorialStage:
    if moves:
        return "export" if has_played else "play"
    new = _handles(project.document) - guide.handles
    wanted = HOLDS_AND_MOVES if guide.handle_place is None else 1
    if len(new) < wanted and not any(map(is_first_pose_changed, project.document.layers)):
        return "handle"
    playhead, first = project.timeline.playhead, project.layer.keys[0].frame
    return "time" if playhead.since is not None or playhead.frame == first else "pose"


def _moves(layer: Layer) -> bool:
    """Return whether a layer has several different poses, or a track that moves a handle."""
    if any(len(track.keys) > 1 for track in layer.tracks):
        return True
    first = layer.map_of(layer.keys[0].pose)
    return any(not layer.map_of(key.pose).is_same(first) for key in layer.keys[1:])


class SampleFile(NamedTuple):
    """A picture, or a project with its picture, that ships with Lissom."""

    name: str
    file: Path
    picture: Path
    what: str
    story: str
    moving: Path  # a small animation; the file may be missing


@cache
def sample_files() -> tuple[SampleFile, ...]:
    """Return the samples, animated ones first."""
    found = []
    projects = {path.stem: path for path in sample_images().glob(f"*{PROJECT}")}
    pictures = {path.stem: path for path in sample_images().glob("*.png")}
    # A layered drawing has no picture but the thumbnail in its project.
    for name in sorted(projects.keys() | pictures.keys()):
        picture = pictures.get(name, projects.get(name, Path()))
        is_animated = name in projects
        found.append(
            SampleFile(
                name=picture.stem.capitalize(),
                file=projects.get(name, picture),
                picture=picture,
                what=_("animated") if is_animated else _("picture"),
                story=STORIES.get(picture.stem.capitalize(), ""),
                moving=sample_images() / "moving" / f"{name}.webp",
            )
        )
    return tuple(sorted(found, key=lambda sample: sample.file.suffix != PROJECT))
