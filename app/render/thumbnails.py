"""Small pictures of files and of layers, as textures for the window."""

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
    """Owner of one small texture for each picture or project that was asked for."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._textures: dict[Path, moderngl.Texture | None] = {}
        self._animation_frames: dict[Path, list[moderngl.Texture]] = {}
        self._fresh = True
        self.is_behind = False  # whether more were asked for in this frame than were read

    @property
    def files(self) -> frozenset[Path]:
        """The files that were read."""
        return frozenset(self._textures)

    @property
    def animated_files(self) -> frozenset[Path]:
        """The files whose small animation was read."""
        return frozenset(self._animation_frames)

    def begin_frame(self) -> None:
        """Allow one more file to be read: one a frame, so that the window opens at once."""
        self._fresh, self.is_behind = True, False

    def get(self, path: Path) -> Thumbnail | None:
        """Return a file's thumbnail; None while it is not read, or where it has none."""
        if path not in self._textures:
            if self._fresh:
                self._textures[path] = self._read(path)
            self.is_behind |= not self._fresh
            self._fresh = False
        texture = self._textures.get(path)
        return None if texture is None else Thumbnail(texture.glo, texture.size)

    def animation_frames(self, path: Path) -> list[Thumbnail]:
        """Return the pictures of a small animation; none where it cannot be read."""
        if path not in self._animation_frames:
            pictures = read_animation_frames(path)
            self._animation_frames[path] = [
                _texture(self._context, picture) for picture in pictures
            ]
        return [Thumbnail(texture.glo, texture.size) for texture in self._animation_frames[path]]

    def release(self, but: Path | None = None) -> None:
        """Let the textures go, but those of files in one folder, if it is named.

        Files that are asked for again are read again.
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
    """Owner of one small texture for each layer whose picture was asked for."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._textures: dict[int, tuple[Bytes, moderngl.Texture]] = {}
        self._wanted: set[int] = set()

    def begin_frame(self) -> None:
        """Let those go that were not asked for in the last frame."""
        for identity in self._textures.keys() - self._wanted:
            self._textures.pop(identity)[1].release()
        self._wanted.clear()

    def get(self, identity: int, small: Bytes) -> Thumbnail:
        """Return the small picture of a layer, uint8 (h, w, 4), by the layer's id, as a texture."""
        known = self._textures.get(identity)
        if known is None or known[0] is not small:
            if known is not None:
                known[1].release()
            known = self._textures[identity] = small, _texture(self._context, small)
        self._wanted.add(identity)
        return Thumbnail(known[1].glo, known[1].size)

    def release(self) -> None:
        """Let all textures go."""
        self._wanted.clear()
        self.begin_frame()


def _texture(context: moderngl.Context, small: Bytes) -> moderngl.Texture:
    texture = context.texture((small.shape[1], small.shape[0]), 4, small.tobytes())
    texture.repeat_x = texture.repeat_y = False
    texture.build_mipmaps()
    return texture
