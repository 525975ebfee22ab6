"""Deform groups: one mesh around the pictures of several layers."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from PIL import Image

from app.document import (
    LAYER_KINDS,
    Command,
    Document,
    Layer,
    deform_group_commands,
    layer_commands,
)
from app.errors import LissomError, join_names
from app.solving.reload.alignment import PlacedPicture
from app.solving.reload.replace_picture import distance_notices, start_picture_replacement
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
from engine.arrays import Bytes, readonly

MARGIN = 2  # transparent pixels around the pictures of the members
DARKENING = {"multiply", "darken", "color-burn", "linear-burn"}  # white is invisible


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BendingAsOne:
    """Layers that become members of a deform group; the keys of one of them are solved again."""

    members: tuple[Layer, ...]  # still, from back to front
    group: Layer  # without the solved poses
    picture: Picture  # of the group
    resolver: KeyResolver
    notices: tuple[str, ...]
    heir: Layer | None  # whose handles and keys the group takes over
    resting: tuple[Layer, ...]  # members whose handles and keys rest until the group is parted

    @property
    def command(self) -> Command:
        """The command that applies everything as one undo step."""
        group = self.group.with_poses(self.resolver.poses)
        heir = None if self.heir is None else self.heir.id
        return deform_group_commands.bend_as_one(group, self.members, heir)


def bend_as_one(
    document: Document,
    identities: Iterable[int],
    pictures: Mapping[int, Picture],
    name: str | None = None,
) -> BendingAsOne:
    """Return the deform group of these layers; all is computed at once.

    The group takes over the handles, keys and parents of the member with the most keys and
    handles, and the finest mesh. `pictures` are those of the layers, by id. Raises `LissomError`
    if the layers cannot be members, or have no common shape.
    """
    chosen = set(identities)
    members = tuple(layer for layer in document.layers if layer.id in chosen)
    _require_members(document, members)
    flat = flatten_members(
        members, {layer.id: cut_texture(layer, pictures[layer.id]) for layer in members}
    )
    heir = _find_heir(members)
    picture, data = Picture(rgba=flat.rgba), encode_png(Image.fromarray(flat.rgba))
    identity = layer_commands.next_layer_id(document)
    title = name or _("{layer} and others").format(layer=(heir or members[0]).name)
    imported = ImportedLayer(name=title, data=data, picture=picture)
    posable = [each.meshing for each in members if not each.still]
    finest = max(posable, key=lambda each: each.triangles, default=None)
    made, found = make_posable_layer(imported, identity, finest, is_cut_out=True)
    if made.still:
        reasons = "; ".join(map(message_of, found))
        raise LissomError(_("they have no shape to bend ({reasons})").format(reasons=reasons))
    resolver = start_picture_replacement(_rig_of(heir or made), made, flat.corner)
    if resolver.new_layer is None:
        raise ValueError("a replacement has a new layer")
    group = replace(resolver.new_layer, id=identity, name=title, cut_out=made.cut_out)
    resolver = solve_all(resolver)
    unsolved = [
        _("poses that exceed the limits: {poses}").format(poses=", ".join(resolver.unsolved))
    ]
    resting = tuple(each for each in members if each is not heir and _has_rig(each))
    return BendingAsOne(
        members=tuple(map(make_still_layer, members)),
        group=group,
        picture=picture,
        resolver=resolver,
        notices=(*found, *distance_notices(resolver), *(unsolved if resolver.unsolved else ())),
        heir=heir,
        resting=resting,
    )


def flatten_members(members: Sequence[Layer], textures: Mapping[int, Bytes]) -> PlacedPicture:
    """Return one picture around the drawings of some layers, from back to front.

    Opacity, blend and visibility do not count: the shape has all that the layers can show. White
    paper that only darkens what is behind it has no shape.
    """
    placed = [
        PlacedPicture(textures[layer.id], layer.corner)
        for layer in members
        if not (layer.blend in DARKENING and (textures[layer.id][..., 3] == 255).all())
    ]
    placed = [each.content for each in placed] or [
        PlacedPicture(textures[layer.id], layer.corner) for layer in members
    ]
    placed = [each for each in placed if each.rgba.size]
    if not placed:
        raise LissomError(_("the layers are fully transparent, so there is no shape to bend"))
    left, bottom = (
        min(round(part) for part in parts) - MARGIN
        for parts in zip(*((each.corner.real, each.corner.imag) for each in placed), strict=True)
    )
    right = max(round(each.corner.real) + each.size[0] for each in placed) + MARGIN
    top = max(round(each.corner.imag) + each.size[1] for each in placed) + MARGIN
    flat = Image.new("RGBA", (right - left, top - bottom))
    for each in placed:
        across = round(each.corner.real) - left
        down = top - round(each.corner.imag) - each.size[1]
        flat.alpha_composite(Image.fromarray(each.rgba), (across, down))
    return PlacedPicture(readonly(np.asarray(flat)), complex(left, bottom))


def cut_texture(layer: Layer, picture: Picture) -> Bytes:
    return cut_picture(picture, layer.cut_out, is_alone=False).texture


def _require_members(document: Document, members: Sequence[Layer]) -> None:
    if len(members) < 2:
        raise LissomError(_("a deform group needs at least two layers; select more layers"))
    bent = [
        each.name
        for each in members
        if each.deform_group is not None or document.is_deform_group(each.id)
    ]
    if bent:
        text = _("{layers} are already in a deform group; part it first")
        raise LissomError(text.format(layers=join_names(bent)))


def _has_rig(layer: Layer) -> bool:
    return bool(layer.handles or layer.keys[1:] or layer.attachments)


def _find_heir(members: Sequence[Layer]) -> Layer | None:
    """Return the member whose motion the group takes over: with the most keys, then handles."""
    rigged = [each for each in members if not each.still and _has_rig(each)]
    return max(rigged, key=lambda each: (len(each.keys), len(each.handles)), default=None)


def _rig_of(layer: Layer) -> Layer:
    """Return a layer with what moves it, drawn plainly."""
    channels = {
        (name, part): keys
        for (name, part), keys in layer.channels.items()
        if part is not None or LAYER_KINDS[name].moves_layer
    }
    return replace(
        layer,
        channels=channels,
        hidden=False,
        locked=False,
        reference=False,
        opacity=1.0,
        blend="normal",
        clipped=False,
        group="",
        origin=None,
    )
