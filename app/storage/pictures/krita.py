"""Reading Krita files: zips of a merged picture, and of layers in a format of their own."""

import io
from typing import Final

from app.errors import LissomError, NoticeCollector
from app.storage.files.reading import open_zip
from app.storage.pictures.layered import (
    GroupPaths,
    ImportedLayer,
    LayeredPicture,
    build_layered_picture,
)
from app.storage.pictures.openraster import DAMAGE, LARGEST_PICTURE, read_member
from app.storage.pictures.picture import decode_picture
from app.texts import N_, _

MIMETYPE: Final = b"application/x-krita"
MERGED: Final = "mergedimage.png"
NO_KRITA: Final = N_("it is not a Krita file, or it is damaged")
NOT_MERGED: Final = N_("it contains no merged picture; save the drawing as OpenRaster (.ora)")
MERGED_ALONE: Final = N_(
    "only the merged picture of the file was read; for its layers save the drawing as OpenRaster "
    "(.ora)"
)


def read_krita(data: bytes) -> LayeredPicture:
    """Read the merged picture of a Krita file as a drawing of one layer."""
    try:
        with open_zip(io.BytesIO(data)) as archive:
            if read_member(archive, "mimetype", 1024).strip() != MIMETYPE:
                raise LissomError(_(NO_KRITA))
            if MERGED not in archive.NameToInfo:
                raise LissomError(_(NOT_MERGED))
            merged = read_member(archive, MERGED, LARGEST_PICTURE)
    except DAMAGE as error:
        raise LissomError(_(NO_KRITA)) from error
    collector = NoticeCollector()
    collector.add_warning("picture", _(MERGED_ALONE))
    layer = ImportedLayer(name="picture", data=merged, picture=decode_picture(merged, MERGED))
    return build_layered_picture(layer.picture.size, [layer], GroupPaths(), collector)
