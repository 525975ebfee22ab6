"""Files: pictures, projects, preferences, unsaved work, and what ships with Lissom.

In: paths, and the bytes behind them.
Out: documents, decoded pictures and settings; files that are whole or absent. What cannot be read
or written is a `LissomError`, also where a docstring does not say so.
Imports: `app.document`.
"""

from app.storage.assets import (
    app_icon as app_icon,
    manual_page as manual_page,
    sample_images as sample_images,
    shader_source as shader_source,
)
from app.storage.autosave import (
    SECONDS as SECONDS,
    Autosave as Autosave,
    Origin as Origin,
    find_leftovers as find_leftovers,
    keep_report as keep_report,
    kept_report as kept_report,
    leftover_origin as leftover_origin,
    load_leftover as load_leftover,
    open_faults as open_faults,
    remove_leftover as remove_leftover,
    remove_report as remove_report,
    take_faults as take_faults,
    take_news as take_news,
)
from app.storage.files import (
    IS_FILE as IS_FILE,
    IS_FOLDER as IS_FOLDER,
    NO_ARRAYS as NO_ARRAYS,
    NO_FOLDER as NO_FOLDER,
    NOT_FINITE as NOT_FINITE,
    SAME_FILE as SAME_FILE,
    Cancellation as Cancellation,
    Hold as Hold,
    HoldError as HoldError,
    atomic_file as atomic_file,
    atomic_files as atomic_files,
    check_writable as check_writable,
    clear_abandoned as clear_abandoned,
    lock as lock,
    make_folder as make_folder,
    passing_picture as passing_picture,
    read_arrays as read_arrays,
    read_file as read_file,
    strict_json as strict_json,
    write_arrays as write_arrays,
    write_atomically as write_atomically,
)
from app.storage.json_values import (
    JsonObject as JsonObject,
    as_flag as as_flag,
    as_list as as_list,
    as_number as as_number,
    as_object as as_object,
    as_point as as_point,
    as_text as as_text,
    as_whole as as_whole,
    load_json as load_json,
    shown as shown,
)
from app.storage.layers import (
    as_layer as as_layer,
    flattened as flattened,
    is_layered as is_layered,
    open_layered as open_layered,
    open_merged as open_merged,
    open_pictures as open_pictures,
    posable_layer as posable_layer,
    read_layered as read_layered,
    still_layer as still_layer,
    still_picture as still_picture,
)
from app.storage.opening import (
    Cut as Cut,
    OpenedScene as OpenedScene,
    cut_picture as cut_picture,
    open_picture as open_picture,
)
from app.storage.pictures import (
    ImportedLayer as ImportedLayer,
    LayeredPicture as LayeredPicture,
    Picture as Picture,
    decode_mask as decode_mask,
    decode_picture as decode_picture,
    decode_pictures as decode_pictures,
    encode_mask as encode_mask,
    let_go as let_go,
    on_disk as on_disk,
    require_memory as require_memory,
    side_by_side as side_by_side,
)
from app.storage.preferences import (
    CHECKER as CHECKER,
    LARGEST_GHOST_STEP as LARGEST_GHOST_STEP,
    LARGEST_SCALE as LARGEST_SCALE,
    MOST_GHOSTS as MOST_GHOSTS,
    SMALLEST_SCALE as SMALLEST_SCALE,
    Preferences as Preferences,
    ThemeName as ThemeName,
    home_folder as home_folder,
    load_preferences as load_preferences,
    make_settings_folder as make_settings_folder,
    save_preferences as save_preferences,
    settings_folder as settings_folder,
)
from app.storage.project_file import (
    load_project as load_project,
    project_digest as project_digest,
    save_project as save_project,
)
from app.storage.thumbnail import (
    draw_thumbnail as draw_thumbnail,
    read_moments as read_moments,
    read_thumbnail as read_thumbnail,
    shrink as shrink,
)
