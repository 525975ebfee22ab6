"""Thumbnails of files and of layers, as textures for the window."""

from pathlib import Path
from typing import NamedTuple

import moderngl

from app.storage import read_animation_frames, read_thumbnail
from engine.arrays import Bytes


class Thumbnail(NamedTuple):
    """A texture's OpenGL name, and its width and height in pixels."""

    texture: int
    size: tuple[int, int]


class Thumbnails:
    """Owner of one texture for each requested picture or project."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._textures: dict[Path, moderngl.Texture | None] = {}
        self._animation_frames: dict[Path, list[moderngl.Texture]] = {}
        self._fresh = True
        self.is_behind = False  # whether this frame requested more files than it read

    @property
    def files(self) -> frozenset[Path]:
        """Files that were read."""
        return frozenset(self._textures)

    @property
    def animated_files(self) -> frozenset[Path]:
        """Files whose small animation was read."""
        return frozenset(self._animation_frames)

    def begin_frame(self) -> None:
        """Allow reading one more file: one per frame, so that the window opens at once."""
        self._fresh, self.is_behind = True, False

    def get(self, path: Path) -> Thumbnail | None:
        """Return a file's thumbnail; None before it is read, or if it has none."""
        if path not in self._textures:
            if self._fresh:
                self._textures[path] = self._read(path)
            self.is_behind |= not self._fresh
            self._fresh = False
        texture = self._textures.get(path)
        return None if texture is None else Thumbnail(texture.glo, texture.size)

    def animation_frames(self, path: Path) -> list[Thumbnail]:
        """Return the frames of a small animation; empty if it is unreadable."""
        if path not in self._animation_frames:
            pictures = read_animation_frames(path)
            self._animation_frames[path] = [
                _texture(self._context, picture) for picture in pictures
            ]
        return [Thumbnail(texture.glo, texture.size) for texture in self._animation_frames[path]]

    def release(self, but: Path | None = None) -> None:
        """Release the textures, except those of files in the folder `but`.

        Released files are read again on request.
        """
        while self._animation_frames:
            for moment in self._animation_frames.popitem()[1]:
                moment.release()
        for path in [path for path in self._textures if path.parent != but]:
            texture = self._textures.pop(path)
            if texture is not None:
                texture.release()

    def _read(self, path: Path) -> moderngl.Texture | None:
        small = read_thumbnail(path)
        return None if small is None else _texture(self._context, small)


class LayerPictures:
    """Owner of one texture for each requested layer."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._textures: dict[int, tuple[Bytes, moderngl.Texture]] = {}
        self._wanted: set[int] = set()

    def begin_frame(self) -> None:
        """Release the textures that the last frame did not request."""
        for identity in self._textures.keys() - self._wanted:
            self._textures.pop(identity)[1].release()
        self._wanted.clear()

    def get(self, identity: int, small: Bytes) -> Thumbnail:
        """Return a layer's thumbnail, uint8 (h, w, 4), as a texture cached by the layer's id."""
        known = self._textures.get(identity)
        if known is None or known[0] is not small:
            if known is not None:
                known[1].release()
            known = self._textures[identity] = small, _texture(self._context, small)
        self._wanted.add(identity)
        return Thumbnail(known[1].glo, known[1].size)

    def release(self) -> None:
        self._wanted.clear()
        self.begin_frame()


def _texture(context: moderngl.Context, small: Bytes) -> moderngl.Texture:
    texture = context.texture((small.shape[1], small.shape[0]), 4, small.tobytes())
    texture.repeat_x = texture.repeat_y = False
    texture.build_mipmaps()
    return texture
