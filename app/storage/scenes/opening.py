"""New documents from single pictures, and mesh textures from pictures."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple, Self

from app.cut_out import CutOut, Mask, build_picture_domain, subject_mask, texture
from app.document import Document, LayerOrigin, Meshing, PictureFile, new_layer
from app.storage.pictures.layered import LayeredPicture
from app.storage.pictures.picture import Picture
from app.texts import message_of
from engine.arrays import Booleans, Bytes, freeze
from engine.domain import HoleMap, find_holes
from engine.errors import EngineError


class OpenedScene(NamedTuple):
    """A new document, its decoded pictures by layer id, and notices.

    Notices about several layers are in the document.
    """

    document: Document
    pictures: Mapping[int, Picture]
    notices: tuple[str, ...] = ()  # of a single picture


@dataclass(frozen=True, slots=True, eq=False)
class CutOutResult:
    """The result of cutting the subject out of a picture.

    Parameters
    ----------
    texture : uint8, shape (h, w, 4)
        The picture on the mesh; straight alpha.
    is_all : bool
        Whether every pixel is kept.
    background_like : bool, shape (h, w), optional
        Pixels of the subject that look like the removed background; None if there are none.
    """

    mask: Mask
    texture: Bytes
    is_all: bool
    background_like: Booleans | None = None
    find_holes: Callable[[], HoleMap | None] = lambda: None

    @classmethod
    def of(
        cls,
        kept: Booleans,
        texture: Bytes,
        enclosed: Booleans | None = None,
        find_holes: Callable[[], HoleMap | None] = lambda: None,
    ) -> Self:
        """Return a result with the often used values computed once: pictures are large."""
        leftover = None if enclosed is None or not (enclosed & kept).any() else enclosed & kept
        return cls(Mask.of(kept), texture, bool(kept.all()), leftover, find_holes)

    @property
    def kept(self) -> Booleans:
        """The pixels (h, w) of the subject, unpacked."""
        return self.mask.kept

    @property
    def holes(self) -> HoleMap | None:
        """Holes of the subject; None if the subject has too many parts."""
        return self.find_holes()


def build_scene(drawing: LayeredPicture, meshing: Meshing | None, cut_out: CutOut) -> OpenedScene:
    """Return the scene of a drawing of a single layer.

    Raises `EngineError` if the picture has no subject with an outline.
    """
    (imported,) = drawing.layers
    picture = imported.picture
    meshing = meshing or Meshing.of_size(picture.size)
    domain, remedies = build_picture_domain(
        picture.rgba, triangles=meshing.triangles, detail=meshing.detail, cut_out=cut_out
    )
    file = PictureFile(data=imported.data, suffix=picture.suffix, size=picture.size)
    layer = replace(
        new_layer(file, domain, meshing, cut_out),
        name=imported.name,
        origin=LayerOrigin(drawing=0, index=0),
    )
    notices = (*picture.notices, *map(message_of, remedies))
    document = Document(
        layers=(layer,), drawings=(drawing.drawing_file(0),), import_log=drawing.summary
    )
    return OpenedScene(document, {layer.id: picture}, notices)


def cut_picture(picture: Picture, cut_out: CutOut, *, is_alone: bool = True) -> CutOutResult:
    """Cut the subject out of a picture; without a subject the whole picture stays.

    Finding holes takes time and memory. Unless `is_alone`, holes are found on first use.
    """
    try:
        subject = subject_mask(picture.rgba, cut_out)
    except EngineError:
        # The project was saved before an impossible cut-out was changed again.
        return CutOutResult.of(freeze(picture.rgba[..., 3] > 0), picture.rgba)

    packed, enclosed, opens = Mask.of(subject.mask), subject.enclosed, subject.opens

    @cache
    def find() -> HoleMap | None:
        try:
            return find_holes(packed.kept, enclosed, opens=opens)
        except EngineError:
            return None

    if is_alone:
        find()
    return CutOutResult.of(subject.mask, texture(picture.rgba, subject), enclosed, find)
