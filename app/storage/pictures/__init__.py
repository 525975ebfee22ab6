"""Pictures: one, or one on many layers, as pixels in sRGB with straight alpha.

In: the bytes of a picture file.
Out: decoded pictures, and in words what was done to them.
Imports: `app.document`, `engine.arrays`.
"""

from app.storage.pictures.cores import side_by_side
from app.storage.pictures.layered import Layer, LayeredPicture
from app.storage.pictures.openraster import read_openraster
from app.storage.pictures.photoshop import read_photoshop
from app.storage.pictures.picture import (
    DECODER_ERRORS,
    FORMATS,
    Picture,
    decode_mask,
    decode_picture,
    decode_pictures,
    encode_mask,
    stored_size,
)

__all__ = [
    "DECODER_ERRORS",
    "FORMATS",
    "Layer",
    "LayeredPicture",
    "Picture",
    "decode_mask",
    "decode_picture",
    "decode_pictures",
    "encode_mask",
    "read_openraster",
    "read_photoshop",
    "side_by_side",
    "stored_size",
]
