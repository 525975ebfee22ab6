"""Keys made from sounds: mouths from cues, and what opens with the volume."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from app.document import (
    SLIDER,
    TRACK,
    Cue,
    Document,
    Mouths,
    Sound,
    SwitchGroup,
    SwitchMember,
    VolumeKeys,
    sound_commands,
)
from app.editor.action import do
from app.editor.actions import editing
from app.editor.error_reports import run_job
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.errors import LissomError, display_name
from app.sound import (
    CUE_SUFFIXES,
    LARGEST_CUES,
    Response,
    cues_of_volume,
    follow_volume,
    guess_drawings,
    make_mouth_keys,
    make_volume_values,
    parse_cues,
)
from app.storage import read_file
from app.texts import _, ngettext

READING = JobKind(_("Reading the cues"), _("The cues cannot be used"))


class VolumeTarget(NamedTuple):
    """A switch, a slider, or a handle, that can open with the volume."""

    label: str
    kind: str  # of its channel
    layer: int = 0
    part: int | str = ""


def ask_cues(session: Session, sound: str, switch: str) -> None:
    """Ask for a file of cues for a switch of mouths."""
    title = _("Cues of mouths for {name}").format(name=switch)
    session.ask_file(title, CUE_SUFFIXES, lambda path: do(read_cues, sound, switch, path))


@with_project
def read_cues(session: Session, project: Project, sound: str, switch: str, path: Path) -> None:
    """Read cues on the worker, and make keys of them."""
    name, fps = display_name(path.name), project.document.fps

    def work() -> tuple[Cue, ...]:
        return parse_cues(read_file(path, largest=LARGEST_CUES), name, fps)

    run_job(session, READING, work, lambda cues: make_mouths(session, sound, switch, cues))


@with_project
def make_mouths(
    session: Session, project: Project, sound: str, switch: str, cues: tuple[Cue, ...]
) -> None:
    """Make keys of cues; drawings that were chosen for cues before stay."""
    document = project.document
    before, group = document.sound(sound).mouths, document.switch_group(switch)
    layers = [(each, document.member_name(each)) for each in group.members]
    guessed = dict(guess_drawings(cues, layers))
    if before is not None and before.switch == switch:
        chosen = {name: layer for name, layer in before.drawings if layer in group.members}
        guessed |= {name: layer for name, layer in chosen.items() if name in guessed}
    _put(session, project, document.sound(sound), group, cues, guessed)


@with_project
def choose_drawing(
    session: Session, project: Project, sound: str, cue: str, layer: SwitchMember
) -> None:
    """Show another drawing for all cues of a name."""
    document = project.document
    mouths = document.sound(sound).mouths
    if mouths is not None:
        drawings = {**dict(mouths.drawings), cue: layer}
        group = document.switch_group(mouths.switch)
        _put(session, project, document.sound(sound), group, mouths.cues, drawings)


@with_project
def make_mouths_again(session: Session, project: Project, sound: str) -> None:
    """Make the keys anew, as after the sound was moved."""
    mouths = project.document.sound(sound).mouths
    if mouths is not None:
        make_mouths(session, sound, mouths.switch, mouths.cues)


def _put(
    session: Session,
    project: Project,
    sound: Sound,
    group: SwitchGroup,
    cues: tuple[Cue, ...],
    drawings: Mapping[str, SwitchMember],
) -> None:
    mouths = Mouths(switch=group.name, cues=cues, drawings=tuple(drawings.items()))
    keys = make_mouth_keys(sound, mouths, project.document.fps)
    editing.edit_document(session, sound_commands.set_mouths(sound.name, mouths, keys))
    text = ngettext("{count} key in {switch}.", "{count} keys in {switch}.", len(keys))
    shown = text.format(count=len(keys), switch=group.name)
    session.notices.show(shown, tone="good", topic="mouths")


def list_volume_targets(project: Project) -> list[VolumeTarget]:
    """Return all switches and sliders, and the selected handles of the active layer."""
    document, layer = project.document, project.layer
    found = [
        VolumeTarget(_("Switch {name}").format(name=each.name), "switch", part=each.name)
        for each in document.switch_groups
    ]
    found += [
        VolumeTarget(
            _("Slider {name} of {layer}").format(name=slider.name, layer=each.name),
            SLIDER.name,
            each.id,
            slider.name,
        )
        for each in document.layers
        for slider in each.sliders
        if slider.driver is None
    ]
    return found + [
        VolumeTarget(
            _("Handle {name} of {layer}").format(name=handle.name, layer=layer.name),
            TRACK.name,
            layer.id,
            handle.id,
        )
        for handle in layer.handles
        if handle.id in project.selection.handles
    ]


@with_project
def open_with_volume(session: Session, project: Project, sound: str, target: VolumeTarget) -> None:
    """Make keys that open a switch, a slider or a handle with the volume."""
    document = project.document
    own = document.sound(sound)
    inspected = project.measured.waveforms.get(own.file.sha256)
    if inspected is None:
        raise LissomError(_("the waveform of {name} is not there yet").format(name=own.name))
    tools, fps = session.tools, document.fps
    opened = follow_volume(inspected, fps, tools.response)
    if target.kind == "switch":
        group = document.switch_group(str(target.part))
        cues = cues_of_volume(opened, fps, len(group.members))
        names = {f"{index + 1}": layer for index, layer in enumerate(group.members)}
        if own.mouths is not None and {cue.name for cue in own.mouths.cues} <= {*names}:
            names |= {n: each for n, each in own.mouths.drawings if each in group.members}
        _put(session, project, own, group, cues, names)
        return
    closed, wide = _ends(document, target, tools.opening)
    values = make_volume_values(own, opened, fps)
    keys = tuple((frame, closed + value * (wide - closed)) for frame, value in values)
    made = VolumeKeys(kind=target.kind, layer=target.layer, part=target.part, keys=keys)
    editing.edit_document(session, sound_commands.set_volume_keys(sound, made))
    text = ngettext("{count} key in {target}.", "{count} keys in {target}.", len(keys))
    shown = text.format(count=len(keys), target=target.label)
    session.notices.show(shown, tone="good", topic="mouths")


def _ends(document: Document, target: VolumeTarget, opening: complex) -> tuple[complex, complex]:
    """Return the values of a channel in silence and where the sound is loudest."""
    if target.kind == TRACK.name:
        return 0j, opening
    sliders = document.layer(target.layer).sliders
    places = [
        each.at.real for slider in sliders if slider.name == target.part for each in slider.poses
    ]
    return complex(min(places)), complex(max(places))


def set_volume_response(session: Session, response: Response) -> None:
    session.tools.set_response(response)


def set_volume_opening(session: Session, opening: complex) -> None:
    session.tools.set_opening(opening)


def choose_volume_target(session: Session, label: str) -> None:
    session.tools.set_volume_target(label)
