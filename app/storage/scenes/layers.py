"""Layers, posable or still, of imported layers; documents of imported drawings."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from app.cut_out import CutOut, build_picture_domain
from app.document import (
    Document,
    ExportSettings,
    Framing,
    Layer,
    LayerOrigin,
    Meshing,
    PictureFile,
    new_layer,
)
from app.storage.pictures.layered import ImportedLayer, LayeredPicture
from app.storage.pictures.picture import Picture
from app.texts import _, message_of
from engine.domain import MeshedDomain, rectangle_domain
from engine.errors import EngineError

WHOLE = CutOut(background="none")  # removes only transparent pixels
# Fields of a layer that belong to its picture, its handles and their motion.
DRAWN = (
    *("picture", "domain", "meshing", "cut_out", "is_stale", "still", "stiffness", "mirror"),
    *("handles", "next_handle", "has_auto_pins", "tracks", "springs", "bones", "library"),
    *("sliders", "motions", "unread_motions", "variant", "bounds"),
)


def make_posable_layer(
    imported: ImportedLayer,
    identity: int,
    meshing: Meshing | None,
    cut_out: CutOut = CutOut(),
    *,
    is_cut_out: bool,
) -> tuple[Layer, tuple[str, ...]]:
    """Return a posable layer of an imported layer, in its drawn place, with notices.

    With `is_cut_out`, transparency alone separates the subject, and a fully opaque layer becomes a
    still picture. Otherwise the `cut_out` separates it.
    """
    picture = imported.picture
    meshing = meshing or Meshing.of_size(picture.size)
    notices: tuple[str, ...] = (
        _("the picture is opaque everywhere, so there is no shape to pose"),
    )
    if not (is_cut_out and picture.is_opaque):
        cut_out = WHOLE if is_cut_out else cut_out
        try:
            domain, found = build_picture_domain(
                picture.rgba,
                triangles=meshing.triangles,
                detail=meshing.detail,
                cut_out=cut_out,
            )
            made = place_imported_layer(imported, identity, domain, meshing, cut_out)
            return replace(made, still=False), tuple(map(message_of, found))
        except EngineError as error:
            notices = (_("cannot be posed: {reason}").format(reason=message_of(error)),)
    return place_imported_layer(imported, identity, rectangle_of(picture), meshing, WHOLE), notices


def place_imported_layer(
    imported: ImportedLayer, identity: int, domain: MeshedDomain, meshing: Meshing, cut_out: CutOut
) -> Layer:
    """Return the still layer of an imported layer, in its drawn place."""
    picture = imported.picture
    file = PictureFile(data=imported.data, suffix=picture.suffix, size=picture.size)
    return replace(
        new_layer(file, domain.moved(imported.corner), meshing, cut_out),
        id=identity,
        name=imported.name,
        corner=imported.corner,
        still=True,
        hidden=not imported.visible,
        opacity=imported.opacity,
        blend=imported.blend,
        clipped=imported.clipped,
        group=imported.group,
    )


def rectangle_of(picture: Picture) -> MeshedDomain:
    return rectangle_domain(*picture.size)


def make_still_picture(data: bytes, picture: Picture) -> Layer:
    """Return the layer of a still picture, with its lower left corner at 0."""
    file = PictureFile(data=data, suffix=picture.suffix, size=picture.size)
    made = new_layer(file, rectangle_domain(*picture.size), Meshing(), WHOLE)
    return replace(made, still=True)


def make_still_layer(layer: Layer) -> Layer:
    """Return the layer as a still picture in its drawn place, with the same cut-out.

    All channels but the poses stay, such as parent, transform and opacity, and the cycles.
    """
    domain = rectangle_domain(*layer.picture.size).moved(layer.corner)
    rest = new_layer(layer.picture, domain, layer.meshing, layer.cut_out)
    return place_as_layer(replace(rest, still=True), layer)


def place_as_layer(layer: Layer, replaced: Layer) -> Layer:
    """Return a layer, posable or still, as drawn, in the place of another layer.

    The channels of the other layer's handles are left out.
    """
    if layer.picture is not replaced.picture:
        replaced = replaced.without_footage()
    anchor = replaced.anchor
    if anchor is not None:
        anchor = complex(layer.domain.nearest(np.array([anchor]))[0])
    return replace(
        replaced,
        **{name: getattr(layer, name) for name in DRAWN},
        anchor=anchor,
        keys=(replace(layer.keys[0], frame=replaced.keys[0].frame),),
        channels={name: keys for name, keys in replaced.channels.items() if name[1] is None},
    )


def document_of_drawing(drawing: LayeredPicture, layers: Sequence[Layer]) -> Document:
    """Return the document of a drawing, with one layer for each of the drawing's layers."""
    layers = [
        replace(layer, origin=LayerOrigin(drawing=0, index=index))
        for index, layer in enumerate(layers)
    ]
    # A drawing with a background defines its own frame.
    framing: Framing = "canvas" if layers[0].still else "fit"
    return Document(
        layers=tuple(layers),
        size=drawing.size,
        export=ExportSettings(framing=framing),
        groups=drawing.groups,
        import_log=drawing.summary,
        drawings=(drawing.drawing_file(0),),
    )
