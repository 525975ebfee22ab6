"""The pictures of footage at the frames of an export, at their full size."""

import threading
from collections.abc import Collection

from app.document import Document, footage_picture_at
from app.errors import CANCELLED, LissomError
from app.storage.footage.footage_reader import FootageReader
from app.storage.footage.opening import open_footage
from engine.arrays import Bytes


class FootagePictures:
    """Owner of the open footage of a document's layers.

    Frames may be read on another thread than the one that closes the footage.
    """

    def __init__(self, document: Document) -> None:
        self._document = document
        self._readers: dict[int, FootageReader] = {}
        # The last picture of each layer: several frames may show it.
        self._last: dict[int, tuple[int, Bytes]] = {}
        self._lock = threading.Lock()
        self._is_closed = False

    def read_frame(self, layers: Collection[int], frame: float) -> dict[int, Bytes]:
        """Return the pictures at a frame of those layers, by id, that have footage.

        Raises `LissomError` if a picture cannot be read.
        """
        found = {}
        with self._lock:
            if self._is_closed:
                raise LissomError(CANCELLED)
            for identity in layers:
                layer = self._document.layer(identity)
                number = footage_picture_at(self._document, layer, frame)
                if number is None or layer.footage is None:
                    continue
                if identity not in self._readers:
                    self._readers[identity] = open_footage(layer.footage)
                last = self._last.get(identity)
                if last is None or last[0] != number:
                    last = self._last[identity] = number, self._readers[identity].read(number)
                found[identity] = last[1]
        return found

    def close(self) -> None:
        """Close all files, after the frame that is being read."""
        with self._lock:
            self._is_closed = True
            for reader in self._readers.values():
                reader.close()
            self._readers.clear()
