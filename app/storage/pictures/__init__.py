"""Pictures: one, or one on many layers, as pixels in sRGB with straight alpha.

In: the bytes of a picture file.
Out: decoded pictures, and in words what was done to them.
Imports: `app.document`, `app.storage.preferences`, `engine.arrays`.
"""

from app.storage.pictures.cores import (
    require_memory as require_memory,
    side_by_side as side_by_side,
)
from app.storage.pictures.layered import (
    ImportedLayer as ImportedLayer,
    LayeredPicture as LayeredPicture,
    Names as Names,
    encode_png as encode_png,
)
from app.storage.pictures.openraster import read_openraster as read_openraster
from app.storage.pictures.photoshop import read_photoshop as read_photoshop
from app.storage.pictures.picture import (
    DECODER_ERRORS as DECODER_ERRORS,
    FORMATS as FORMATS,
    Picture as Picture,
    decode_mask as decode_mask,
    decode_picture as decode_picture,
    decode_pictures as decode_pictures,
    encode_mask as encode_mask,
    stored_size as stored_size,
    upright as upright,
)
from app.storage.pictures.scratch import let_go as let_go, on_disk as on_disk
