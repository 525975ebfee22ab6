"""Pictures, single or layered, as pixels in sRGB with straight alpha.

In: the bytes of a picture file.
Out: decoded pictures, and notices about changes of their contents.
Imports: `app.document`, `app.storage.preferences`, `engine.arrays`.
"""

from app.storage.pictures.layered import (
    ImportedLayer as ImportedLayer,
    LayeredPicture as LayeredPicture,
    UniqueNames as UniqueNames,
    encode_png as encode_png,
)
from app.storage.pictures.mmap_pixels import (
    move_to_disk as move_to_disk,
    release_pages as release_pages,
)
from app.storage.pictures.openraster import read_openraster as read_openraster
from app.storage.pictures.parallel import (
    require_memory as require_memory,
    run_parallel as run_parallel,
)
from app.storage.pictures.photoshop import read_photoshop as read_photoshop
from app.storage.pictures.picture import (
    DECODER_ERRORS as DECODER_ERRORS,
    FORMATS as FORMATS,
    Picture as Picture,
    apply_orientation as apply_orientation,
    decode_mask as decode_mask,
    decode_picture as decode_picture,
    decode_pictures as decode_pictures,
    encode_mask as encode_mask,
    stored_size as stored_size,
)
