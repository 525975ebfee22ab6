"""Deform groups whose members have other pictures, and parting them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from PIL import Image

from app.document import (
    Command,
    Document,
    Layer,
    PictureFile,
    combine_commands,
    deform_group_commands,
    layer_commands,
)
from app.solving.deform_group.bending import cut_texture, flatten_members
from app.solving.reload.pictures import PlacedMask, move_cut_out
from app.solving.reload.replace_picture import distance_notices, start_picture_replacement
from app.solving.reload.shifting import shift_layer
from app.solving.resolve_keys import KeyResolver, solve_all
from app.storage import (
    ImportedLayer,
    Picture,
    cut_picture,
    encode_png,
    make_posable_layer,
    make_still_layer,
)
from app.texts import _, message_of


def part_deform_group(
    document: Document, identity: int, pictures: Mapping[int, Picture]
) -> tuple[Command, tuple[str, ...]]:
    """Return the command that parts a deform group, with notices.

    A member whose picture was replaced meanwhile gets a new mesh, without handles.
    """
    restored, notices = {}, list[str]()
    for member in document.deform_members(identity):
        earlier = deform_group_commands.layer_before_bending(member)
        earlier = shift_layer(earlier, member.corner - earlier.corner)
        before = member.before_bending
        if before is not None and before.picture is not member.picture:
            earlier = _redrawn(earlier, member, pictures[member.id])
            notices.append(
                _("{layer} has another picture since, so its keys were solved again").format(
                    layer=member.name
                )
            )
        restored[member.id] = earlier
    return deform_group_commands.part_deform_group(identity, restored), tuple(notices)


def _redrawn(earlier: Layer, member: Layer, picture: Picture) -> Layer:
    """Return a layer as it was before it became a member, with the member's present picture."""
    imported = ImportedLayer(name=member.name, data=member.picture.data, picture=picture)
    made, _notices = make_posable_layer(
        imported, member.id, earlier.meshing, member.cut_out, is_cut_out=False
    )
    if made.still:
        return replace(make_still_layer(earlier), picture=member.picture)
    layer = _solved_layer(start_picture_replacement(earlier, made, member.corner))
    return replace(layer, picture=member.picture)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RebuiltGroup:
    """A deform group around other pictures of its members."""

    picture: Picture
    layer: Layer | None = None  # None if the keys must be solved again
    resolver: KeyResolver | None = None
    notices: tuple[str, ...] = ()


def rebuild_group(
    group: Layer,
    members: Sequence[Layer],
    old: Mapping[int, Picture],
    now: Mapping[int, Picture],
    shift: complex = 0j,
) -> RebuiltGroup:
    """Return a deform group around the present pictures of its members.

    Parameters
    ----------
    members : sequence of Layer
        As they are now.
    old, now : mapping of int to Picture
        The earlier picture of the group, and the present ones of the members, by layer id.
    shift : complex
        By which all members moved on the canvas.

    With an equal shape only the picture changes. A shape that cannot be bent stays, with a notice.
    """
    flat = flatten_members(members, {each.id: cut_texture(each, now[each.id]) for each in members})
    picture, data = Picture(rgba=flat.rgba), encode_png(Image.fromarray(flat.rgba))
    moved = shift_layer(group, shift)
    was = cut_picture(old[group.id], group.cut_out, is_alone=False)
    cut_out = move_cut_out(group.cut_out, moved.corner - flat.corner, picture.size)
    shape = cut_picture(picture, cut_out, is_alone=False)
    if PlacedMask.of(was.kept, moved.corner) == PlacedMask.of(shape.kept, flat.corner):
        file = PictureFile(data=data, suffix=picture.suffix, size=picture.size)
        same = replace(moved, picture=file, corner=flat.corner, cut_out=cut_out)
        return RebuiltGroup(picture=picture, layer=same)
    made, notices = make_posable_layer(
        ImportedLayer(name=group.name, data=data, picture=picture),
        group.id,
        group.meshing,
        cut_out,
        is_cut_out=False,
    )
    if made.still:
        reason = "; ".join(map(message_of, notices))
        text = _("{group} keeps its mesh, because there is no shape any more: {reason}")
        notice = text.format(group=group.name, reason=reason)
        return RebuiltGroup(picture=old[group.id], layer=moved, notices=(notice,))
    resolver = start_picture_replacement(group, made, flat.corner, shift)
    found = (*notices, *distance_notices(resolver))
    return RebuiltGroup(picture=picture, resolver=resolver, notices=found)


def replace_member_picture(
    document: Document, member: Layer, picture: Picture, pictures: Mapping[int, Picture]
) -> tuple[Command, dict[PictureFile, Picture], tuple[str, ...]]:
    """Return the command that gives a member of a deform group another picture.

    Return also the new pictures, and notices. `member` has the new picture; `pictures` are those of
    all layers before, by id.
    """
    group = document.deform_layer(member)
    members = [
        member if each.id == member.id else each for each in document.deform_members(group.id)
    ]
    rebuilt = rebuild_group(group, members, pictures, {**pictures, member.id: picture})
    layer = rebuilt.layer if rebuilt.resolver is None else _solved_layer(rebuilt.resolver)
    if layer is None:
        raise ValueError("a rebuilt group has a layer or is solved again")
    commands = (
        layer_commands.replace_layer(member.id, member),
        layer_commands.replace_layer(group.id, layer),
    )
    known = {member.picture: picture, layer.picture: rebuilt.picture}
    return combine_commands(_("Replace picture"), commands), known, rebuilt.notices


def _solved_layer(resolver: KeyResolver) -> Layer:
    """Return the new layer of a resolver with all poses solved."""
    resolver = solve_all(resolver)
    if resolver.new_layer is None:
        raise ValueError("a replacement has a new layer")
    return resolver.new_layer.with_poses(resolver.poses)
