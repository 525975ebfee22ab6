"""Small pictures of files, as textures for the window."""

from pathlib import Path
from typing import NamedTuple

import moderngl

from app.storage import read_thumbnail


class Thumbnail(NamedTuple):
    """A texture's OpenGL name, and its width and height in pixels."""

    texture: int
    size: tuple[int, int]


class Thumbnails:
    """Owner of one small texture for each picture or project that was asked for.

    Parameters
    ----------
    context : moderngl.Context
    """

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._textures: dict[Path, moderngl.Texture | None] = {}
        self._fresh = True
        self.is_behind = False  # whether more were asked for in this frame than were read

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

    def textures(self) -> list[moderngl.Texture]:
        """Return all that are ready."""
        return [texture for texture in self._textures.values() if texture is not None]

    def release(self) -> None:
        """Let the textures go; files that are asked for again are read again."""
        for texture in self.textures():
            texture.release()
        self._textures.clear()

    def _read(self, path: Path) -> moderngl.Texture | None:
        small = read_thumbnail(path)
        if small is None:
            return None
        texture = self._context.texture((small.shape[1], small.shape[0]), 4, small.tobytes())
        texture.repeat_x = texture.repeat_y = False
        texture.build_mipmaps()
        return texture
