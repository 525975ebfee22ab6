"""Closing seams between a layer and its parent."""

from dataclasses import replace

from PIL import Image

from app.editor import pending_changes
from app.editor.action import do
from app.editor.actions import playback
from app.editor.actions.layer_setup import resolving
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.errors import LissomError
from app.solving import KeyResolver, PlacedPicture, extend_under, start_picture_replacement
from app.storage import (
    ImportedLayer,
    Picture,
    encode_png,
    make_posable_layer,
    make_still_picture,
)
from app.texts import _

CLOSING = JobKind(_("Closing a seam"), _("The seam was not closed"))


def close_seam(session: Session, identity: int) -> None:
    """Extend the picture behind by one pixel under the other one, of a layer and its parent."""
    pending_changes.run_when_idle(session, do(_close_seam, identity), _("Close seam"))


@with_project
def _close_seam(session: Session, project: Project, identity: int) -> None:
    document = project.document
    frame = playback.current_frame(session, project)
    joint = document.attachment_at(document.layer(identity), frame)
    if joint is None or joint.parent is None:
        return
    pair = {identity, joint.parent}
    behind, front = (layer for layer in document.layers if layer.id in pair)
    if behind.footage is not None:
        text = _("{behind} shows footage, so its picture cannot be extended under {front}.")
        raise LissomError(text.format(behind=behind.name, front=front.name))
    if document.is_deform_group(behind.id):
        text = _("{behind} has the pictures of its members. Draw them on under {front} instead.")
        raise LissomError(text.format(behind=behind.name, front=front.name))
    placed = [
        PlacedPicture(project.runtimes.layers[each.id].picture.rgba, each.corner)
        for each in (behind, front)
    ]

    def work() -> tuple[KeyResolver, Picture]:
        grown = extend_under(*placed)
        if grown is None:
            text = _("{behind} and {front} do not meet, or {behind} already reaches under {front}")
            raise LissomError(text.format(behind=behind.name, front=front.name))
        data = encode_png(Image.fromarray(grown.rgba))
        picture = Picture(rgba=grown.rgba)
        if behind.still:
            made = make_still_picture(data, picture)
        else:
            imported = ImportedLayer(name=behind.name, data=data, picture=picture)
            made, _notices = make_posable_layer(
                imported, behind.id, behind.meshing, is_cut_out=True
            )
        resolver = start_picture_replacement(behind, made, grown.corner)
        closed = resolver.new_layer and replace(resolver.new_layer, closed_seam=front.id)
        return replace(resolver, label=_("Close seam"), new_layer=closed), picture

    def done(begun: tuple[KeyResolver, Picture]) -> None:
        resolver, picture = begun
        if resolver.new_layer is not None:
            project.runtimes.keep_picture(resolver.new_layer.picture, picture)
        resolving.begin_solving_keys(session, resolver)

    pending_changes.begin_pending_change(session, project, CLOSING, work, done)
