"""Actions on springs: baking a spring's swing into keys of a track."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from app.document import Document, Spring, Track, TrackKey, track_commands
from app.editor import pending_changes
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.motion import PoseSampler, find_parent_motion, layer_animation
from app.rigging import fit_keys
from app.texts import _, ngettext
from engine.arrays import Complexes, Indices
from engine.geometry import diameter

KEYING = JobKind(_("Baking a spring"), _("The spring could not be baked"))
NEAR = 4e-4  # of the layer's diameter: largest distance of the keys' motion from the swing
AT_REST = 0.01  # pixels


class _Swing(NamedTuple):
    """Offsets of a handle from the pose, at frames from first to last, complex (n,)."""

    frames: Indices
    offsets: Complexes


@with_project
def bake_spring(session: Session, project: Project, handle: int) -> None:
    """Replace a handle's spring by a track that swings in the same way."""
    layer, spring = project.layer, project.layer.spring_of(handle)
    if spring is None or not spring.enabled or layer.track_of(handle) is not None:
        return
    work = partial(_measure, project.document, layer.id, handle, project.samplers)

    def take(swing: _Swing) -> None:
        _put(session, project, layer.id, spring, swing)

    pending_changes.begin_pending_change(session, project, KEYING, work, take)


def _measure(
    document: Document, identity: int, handle: int, siblings: Mapping[int, PoseSampler]
) -> _Swing:
    """Measure a handle's offset from its pose without the spring."""
    without = track_commands.remove_springs(identity, (handle,))(document)
    point = np.array([document.layer(identity).handle(handle).position])
    swinging, resting = (
        layer_animation(
            each, identity, point, siblings, find_parent_motion(each, identity, siblings)
        )
        for each in (document, without)
    )
    frames = np.arange(document.frames.first, document.frames.last + 1)
    offsets = []
    for frame in frames.tolist():
        still = resting.base.frame(frame)
        fz = complex(still.fz[0])
        offset = complex(swinging.positions(frame)[0] - still.positions[0])
        offsets.append(offset * fz.conjugate() / abs(fz))
    return _Swing(frames, np.array(offsets))


def _put(session: Session, project: Project, identity: int, spring: Spring, swing: _Swing) -> None:
    """Replace a spring by a track with a swing, unless the spring has changed meanwhile."""
    layers = {layer.id: layer for layer in project.document.layers}
    layer = layers.get(identity)
    if layer is None or spring not in layer.springs:
        return
    moves = np.flatnonzero(np.abs(swing.offsets) > AT_REST)
    if not len(moves):
        session.notices.show(
            _(
                "The handle does not swing, because the shape does not move there. Pose another "
                "key first."
            )
        )
        return
    # The swing begins and ends at rest if there is room for that.
    first, last = max(moves[0] - 1, 0), min(moves[-1] + 1, len(swing.frames) - 1)
    part = slice(first, last + 1)
    near = NEAR * diameter(layer.domain.outline)
    fitted = fit_keys(swing.frames[part], swing.offsets[part], near)
    keys = [
        TrackKey(frame=frame, place=place, velocity=velocity)
        for frame, place, velocity in zip(*(each.tolist() for each in fitted), strict=True)
    ]
    if project.document.loop and last - first == len(swing.frames) - 1:
        keys[-1] = replace(keys[0], frame=keys[-1].frame)
    gesture = object()
    track = Track(handles=(spring.handle,), keys=tuple(keys))
    for command in (
        track_commands.remove_springs(identity, (spring.handle,)),
        track_commands.put_track(identity, track),
    ):
        project.history.do(command, gesture=gesture)
    project.timeline.show_lanes(identity)
    if project.selection.active == identity:
        project.selection.select_track(project.layer, spring.handle)
    text = ngettext(
        "The spring is now a track with {count} key.",
        "The spring is now a track with {count} keys.",
        len(keys),
    )
    session.notices.show(text.format(count=len(keys)))
