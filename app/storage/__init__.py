"""Files: pictures, projects, preferences, unsaved work, and what ships with Lissom.

In: paths, and the bytes behind them.
Out: documents, decoded pictures and settings; files that are whole or absent.
Imports: `app.document`.
"""

from app.storage.assets import app_icon, sample_images, shader_source
from app.storage.autosave import (
    SECONDS,
    Autosave,
    Origin,
    find_leftovers,
    load_leftover,
    remove_leftover,
)
from app.storage.files import (
    atomic_file,
    check_writable,
    read_arrays,
    write_arrays,
    write_atomically,
)
from app.storage.json_values import (
    JsonObject,
    as_flag,
    as_list,
    as_number,
    as_object,
    as_point,
    as_text,
    as_whole,
    without_repeats,
)
from app.storage.layers import (
    OpenedScene,
    as_scene,
    flattened,
    is_layered,
    layer_figure,
    open_layered,
    open_pictures,
    read_layered,
    still_figure,
)
from app.storage.opening import Cut, cut_picture, open_picture
from app.storage.pictures import (
    Layer,
    Picture,
    decode_mask,
    decode_picture,
    decode_pictures,
    encode_mask,
    read_picture_file,
    side_by_side,
)
from app.storage.preferences import (
    CHECKER,
    LARGEST_GHOST_STEP,
    LARGEST_SCALE,
    MOST_GHOSTS,
    SMALLEST_SCALE,
    Preferences,
    ThemeName,
    load_preferences,
    save_preferences,
    settings_folder,
)
from app.storage.project_file import load_project, save_project
from app.storage.thumbnail import draw_thumbnail, read_thumbnail

__all__ = [
    "CHECKER",
    "LARGEST_GHOST_STEP",
    "LARGEST_SCALE",
    "MOST_GHOSTS",
    "SECONDS",
    "SMALLEST_SCALE",
    "Autosave",
    "Cut",
    "JsonObject",
    "Layer",
    "OpenedScene",
    "Origin",
    "Picture",
    "Preferences",
    "ThemeName",
    "app_icon",
    "as_flag",
    "as_list",
    "as_number",
    "as_object",
    "as_point",
    "as_scene",
    "as_text",
    "as_whole",
    "atomic_file",
    "check_writable",
    "cut_picture",
    "decode_mask",
    "decode_picture",
    "decode_pictures",
    "draw_thumbnail",
    "encode_mask",
    "find_leftovers",
    "flattened",
    "is_layered",
    "layer_figure",
    "load_leftover",
    "load_preferences",
    "load_project",
    "open_layered",
    "open_picture",
    "open_pictures",
    "read_arrays",
    "read_layered",
    "read_picture_file",
    "read_thumbnail",
    "remove_leftover",
    "sample_images",
    "save_preferences",
    "save_project",
    "settings_folder",
    "shader_source",
    "side_by_side",
    "still_figure",
    "without_repeats",
    "write_arrays",
    "write_atomically",
]
