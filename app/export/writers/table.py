"""The table of each format's writer."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from types import MappingProxyType
from typing import IO, Final

from app.export.destination import data_file
from app.export.morph_mesh import MorphScene
from app.export.plan import ExportPlan
from app.export.writers.apng import ApngWriter
from app.export.writers.frame_writer import FrameWriter
from app.export.writers.gif import GifWriter
from app.export.writers.glb import build_glb
from app.export.writers.html import build_html_page
from app.export.writers.png import PngPicture, PngSequence
from app.export.writers.spritesheet import SpritesheetWriter
from app.export.writers.webp import WebpWriter
from app.storage import Cancellation, atomic_file, atomic_files, make_folder


def _video(file: IO[bytes], plan: ExportPlan) -> FrameWriter:
    from app.export.writers.video import VideoWriter  # noqa: PLC0415 - slow, and needs an extra

    return VideoWriter(file, plan)


# By the names of `EXPORT_FORMATS`: formats of a folder of frames, formats of one file of frames,
# and mesh formats, whose functions return the contents of their file.
FOLDER_WRITERS: Final[Mapping[str, Callable[[ExportPlan, Cancellation], FrameWriter]]] = (
    MappingProxyType({"png": PngSequence})
)
FILE_WRITERS: Final[Mapping[str, Callable[[IO[bytes], ExportPlan], FrameWriter]]] = (
    MappingProxyType(
        {
            "picture": PngPicture,
            "apng": ApngWriter,
            "gif": GifWriter,
            "webp": WebpWriter,
            "mp4": _video,
            "webm": _video,
            "mov": _video,
        }
    )
)
# Formats of one file of frames with a data file beside it.
DATA_WRITERS: Final[Mapping[str, Callable[[IO[bytes], IO[bytes], ExportPlan], FrameWriter]]] = (
    MappingProxyType({"spritesheet": SpritesheetWriter})
)
SHAPE_WRITERS: Final[Mapping[str, Callable[[MorphScene, ExportPlan], bytes]]] = MappingProxyType(
    {"glb": build_glb, "html": build_html_page}
)


@contextmanager
def open_writer(plan: ExportPlan, cancellation: Cancellation) -> Iterator[FrameWriter]:
    """Yield the writer of a plan's format for the duration of the `with` block.

    The file takes its place at the end of the block; after an error there is no file.

    Raises `LissomError` if the folder or the file cannot be made, or the format cannot hold such
    frames.
    """
    if plan.format in FOLDER_WRITERS:
        make_folder(plan.out)
        with closing(FOLDER_WRITERS[plan.format](plan, cancellation)) as writer:
            yield writer
    elif (beside := data_file(plan.out, plan.format)) is not None:
        with (
            atomic_files(plan.out, beside, cancellation=cancellation) as (file, data),
            closing(DATA_WRITERS[plan.format](file, data, plan)) as writer,
        ):
            yield writer
    else:
        with (
            atomic_file(plan.out, cancellation) as file,
            closing(FILE_WRITERS[plan.format](file, plan)) as writer,
        ):
            yield writer
