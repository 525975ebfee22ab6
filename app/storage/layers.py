"""Layers of one scene, from a layered drawing or from several pictures."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from app.cut_out import CutOut, build_picture_domain
from app.document import (
    CompositeGroup,
    Document,
    ExportSettings,
    Framing,
    Layer,
    Meshing,
    PictureFile,
    composite_layers,
    is_visible,
    new_layer,
)
from app.errors import LissomError, NoticeCollector, display_name
from app.storage.files.reading import read_file
from app.storage.opening import OpenedScene, build_scene, cut_picture
from app.storage.pictures.blending import blend_pictures
from app.storage.pictures.layer_names import UniqueNames
from app.storage.pictures.layered import ImportedLayer, LayeredPicture, encode_png
from app.storage.pictures.openraster import read_openraster
from app.storage.pictures.parallel import run_parallel
from app.storage.pictures.photoshop import read_photoshop
from app.storage.pictures.picture import Picture, decode_pictures
from app.texts import _, message_of
from engine.arrays import Bytes, readonly
from engine.domain import rectangle_domain
from engine.errors import EngineError

READERS = {".ora": read_openraster, ".psd": read_photoshop}
# Minimum per layer, however many layers share the triangles.
FEWEST_TRIANGLES = 4_000
LARGEST_FLAT = 1_024  # pixels: layers on a canvas of twice this size are reduced
WHOLE = CutOut(background="none")  # removes only transparent pixels
# Fields of a layer that belong to its picture, its handles and their motion.
DRAWN = (
    *("picture", "domain", "meshing", "cut_out", "is_stale", "still", "stiffness", "mirror"),
    *("handles", "next_handle", "has_auto_pins", "tracks", "springs", "bones", "library"),
    *("motions", "unread_motions", "variant", "bounds"),
)


def is_layered(path: Path) -> bool:
    """Return whether a file's name ends as that of a layered drawing."""
    return path.suffix.lower() in READERS


def read_layered(path: Path) -> LayeredPicture:
    data = read_file(path)
    try:
        return READERS[path.suffix.lower()](data)
    except LissomError as error:
        raise LissomError(
            _("cannot open {path}: {error}").format(path=path, error=error)
        ) from error


def open_layered(path: Path, meshing: Meshing) -> OpenedScene:
    """Read a layered drawing, and make a layer of each of its layers.

    A layer that is fully opaque, or without a shape, becomes a still picture. All layers together
    have as many triangles as one picture.
    """
    return _scene(read_layered(path), meshing, is_cut_out=True)


def open_merged(path: Path, meshing: Meshing, cut_out: CutOut = CutOut()) -> OpenedScene:
    """Read a layered drawing, merged into one picture of its visible layers."""
    scene = open_layered(path, Meshing(detail="coarse", triangles=FEWEST_TRIANGLES))
    textures = {
        layer.id: cut_picture(scene.pictures[layer.id], layer.cut_out).texture
        for layer in scene.document.layers
    }
    merged = encode_png(Image.fromarray(flatten_layers(scene.document, textures)))
    opened = build_scene(merged, path.with_suffix(".png"), meshing, cut_out)
    count = len(scene.document.layers)
    merged_layers = _("the {count} layers of {name} were merged into one drawing").format(
        count=count, name=path.name
    )
    notices = (merged_layers,) if count > 1 else ()
    document = replace(opened.document, import_log=scene.document.import_log)
    return opened._replace(document=document, notices=notices + opened.notices)


def open_pictures(paths: Sequence[Path], meshing: Meshing) -> OpenedScene:
    """Read several pictures, and make a layer of each, the first one at the back.

    The canvas has the size of the largest picture; the others are centred.
    """
    all_imported: list[ImportedLayer] = []
    names, collector = UniqueNames(), NoticeCollector()
    files = [(read_file(path), str(path)) for path in paths]
    pictures = decode_pictures(files)
    size = (
        max(picture.size[0] for picture in pictures),
        max(picture.size[1] for picture in pictures),
    )
    for path, (data, _name), picture in zip(paths, files, pictures, strict=True):
        name = names.claim(display_name(path.stem))
        corner = complex((size[0] - picture.size[0]) // 2, (size[1] - picture.size[1]) // 2)
        all_imported.append(ImportedLayer(name=name, data=data, picture=picture, corner=corner))
        for notice in picture.notices:
            collector.add_note(name, notice)
    drawing = LayeredPicture(size=size, layers=tuple(all_imported), summary=collector.import_log)
    return _scene(drawing, meshing, is_cut_out=False)


def flatten_layers(document: Document, textures: Mapping[int, Bytes]) -> Bytes:
    """Return the initially visible layers as one picture, as drawn; a large one is reduced.

    Parameters
    ----------
    textures : mapping of int to uint8, shape (h, w, 4)
        The cut-out pictures by layer id.

    Returns
    -------
    uint8, shape (h, w, 4)
        Straight alpha.
    """
    factor = max(1, max(document.canvas) // LARGEST_FLAT)
    if len(document.layers) == 1:
        return np.asarray(_reduced(textures[document.layers[0].id], factor))
    size = -(-document.canvas[0] // factor), -(-document.canvas[1] // factor)

    def drawn(layer: Layer) -> Image.Image:
        imported, corner = _reduced(textures[layer.id], factor), layer.corner / factor
        moved = Image.new("RGBA", size)
        moved.paste(imported, (round(corner.real), round(size[1] - corner.imag - imported.height)))
        return moved

    def over(flat: Image.Image, parts: Sequence[Layer | CompositeGroup[Layer]]) -> Image.Image:
        for part in parts:
            if isinstance(part, CompositeGroup) and part.is_pass_through:
                faded = Image.blend(
                    flat.convert("RGBa"), over(flat, part.parts).convert("RGBa"), part.opacity
                )
                flat = faded.convert("RGBA")
            elif isinstance(part, CompositeGroup):
                flat = _blended(flat, over(Image.new("RGBA", size), part.parts), part)
            else:
                flat = Image.alpha_composite(flat, drawn(part))
        return flat

    first = document.frames.first
    seen = {each.id: each for each in document.exported_layers if is_visible(document, each, first)}
    painted = over(Image.new("RGBA", size), composite_layers(document, seen, first))
    return readonly(np.asarray(painted))


def _blended(below: Image.Image, above: Image.Image, how: CompositeGroup[Layer]) -> Image.Image:
    """Return a layer over its backdrop ("Compositing and Blending Level 1", Section 10)."""
    alpha = above.getchannel("A").point(lambda a: round(how.opacity * a))
    covered = below.getchannel("A")
    # A clipped layer meets its backdrop as if the backdrop were opaque.
    solid = below.convert("RGB").convert("RGBA") if how.clipped else below
    if how.blend != "normal":
        own = above.convert("RGB")
        mixed = blend_pictures(below.convert("RGB"), own, how.blend)
        # Over an empty backdrop the layer keeps its colours.
        above = Image.composite(mixed, own, solid.getchannel("A")).convert("RGBA")
    above.putalpha(alpha)
    flat = Image.alpha_composite(solid, above)
    if how.clipped:
        flat.putalpha(covered)
    return flat


def _reduced(rgba: Bytes, factor: int) -> Image.Image:
    """Return a picture in which one pixel stands for `factor` × `factor` pixels."""
    # Process a few rows at a time: a whole copy would double the memory.
    rows = (rgba[top : top + factor] for top in range(0, len(rgba), factor))
    return Image.fromarray(np.concatenate([Image.fromarray(row).reduce(factor) for row in rows]))


def make_posable_layer(
    imported: ImportedLayer, identity: int, meshing: Meshing, *, is_cut_out: bool
) -> tuple[Layer, tuple[str, ...]]:
    """Return a posable layer of an imported layer, in its drawn place, with notices.

    With `is_cut_out`, transparency alone separates the subject, and a fully opaque layer becomes a
    still picture. Otherwise a plain background is removed first.
    """
    picture = imported.picture
    file = PictureFile(data=imported.data, suffix=picture.suffix, size=picture.size)
    cut_out = WHOLE if is_cut_out else CutOut()
    domain, still = rectangle_domain(*picture.size), True
    notices: tuple[str, ...] = (
        _("the picture is opaque everywhere, so there is no shape to pose"),
    )
    if not (is_cut_out and picture.is_opaque):
        try:
            domain, found = build_picture_domain(
                picture.rgba,
                triangles=meshing.triangles,
                detail=meshing.detail,
                cut_out=cut_out,
            )
            still, notices = False, tuple(map(message_of, found))
        except EngineError as error:
            notices = (_("cannot be posed: {reason}").format(reason=message_of(error)),)
    layer = replace(
        new_layer(file, domain.moved(imported.corner), meshing, WHOLE if still else cut_out),
        id=identity,
        name=imported.name,
        corner=imported.corner,
        still=still,
        hidden=not imported.visible,
        opacity=imported.opacity,
        blend=imported.blend,
        clipped=imported.clipped,
        group=imported.group,
    )
    return layer, notices


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


def _scene(drawing: LayeredPicture, meshing: Meshing, *, is_cut_out: bool) -> OpenedScene:
    share = max(FEWEST_TRIANGLES, meshing.triangles // len(drawing.layers))
    each = replace(meshing, triangles=min(meshing.triangles, share))
    made = run_parallel(
        lambda numbered: make_posable_layer(numbered[1], numbered[0], each, is_cut_out=is_cut_out),
        enumerate(drawing.layers),
        (imported.picture.size for imported in drawing.layers),
    )
    # Layers with the same picture share its file.
    files: dict[int, PictureFile] = {}
    layers = tuple(
        replace(layer, picture=files.setdefault(id(imported.picture), layer.picture))
        for imported, (layer, _) in zip(drawing.layers, made, strict=True)
    )
    if all(layer.still for layer in layers):
        raise LissomError(_("none of its layers can be posed, because none contains a shape"))
    pictures = {index: imported.picture for index, imported in enumerate(drawing.layers)}
    collector = NoticeCollector()
    for layer, notices in made:
        for notice in notices:
            collector.add_note(layer.name, notice)
    # A drawing with a background defines its own frame.
    framing: Framing = "canvas" if layers[0].still else "fit"
    document = Document(
        layers=layers,
        size=drawing.size,
        export=ExportSettings(framing=framing),
        groups=drawing.groups,
        import_log=drawing.summary + collector.import_log,
    )
    return OpenedScene(document, pictures)
