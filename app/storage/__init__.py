"""Files: pictures, projects, preferences, unsaved work, and the files that ship with Lissom.

In: paths, and the bytes behind them.
Out: documents, decoded pictures and settings; files that are whole or absent. A file that cannot be
read or written raises `LissomError`, also where a docstring does not list it.
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
    SourceInfo as SourceInfo,
    find_recoverable_files as find_recoverable_files,
    load_recoverable_file as load_recoverable_file,
    load_report as load_report,
    mark_report_seen as mark_report_seen,
    open_fault_log as open_fault_log,
    read_fault_log as read_fault_log,
    read_source_info as read_source_info,
    remove_recoverable_file as remove_recoverable_file,
    remove_report as remove_report,
    write_report as write_report,
)
from app.storage.files.arrays import (
    NO_ARRAYS as NO_ARRAYS,
    read_arrays as read_arrays,
    write_arrays as write_arrays,
)
from app.storage.files.atomic import (
    atomic_file as atomic_file,
    atomic_files as atomic_files,
    remove_abandoned_files as remove_abandoned_files,
    temporary_picture as temporary_picture,
    write_atomically as write_atomically,
)
from app.storage.files.cancellation import Cancellation as Cancellation
from app.storage.files.file_lock import FileLock as FileLock, FileLockedError as FileLockedError
from app.storage.files.locks import lock as lock
from app.storage.files.outputs import (
    IS_FILE as IS_FILE,
    IS_FOLDER as IS_FOLDER,
    NO_FOLDER as NO_FOLDER,
    SAME_FILE as SAME_FILE,
    check_writable as check_writable,
    make_folder as make_folder,
)
from app.storage.files.reading import file_time as file_time, read_file as read_file
from app.storage.files.strict_json import NOT_FINITE as NOT_FINITE, strict_json as strict_json
from app.storage.footage.footage_cache import (
    FootageCache as FootageCache,
    FootageDecoder as FootageDecoder,
    PackedPictures as PackedPictures,
)
from app.storage.footage.footage_pictures import FootagePictures as FootagePictures
from app.storage.footage.footage_reader import FootageReader as FootageReader
from app.storage.footage.opening import (
    VIDEOS as VIDEOS,
    OpenedFootage as OpenedFootage,
    copy_footage as copy_footage,
    inspect_footage as inspect_footage,
    is_footage as is_footage,
    is_video as is_video,
    open_footage as open_footage,
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
    repr_for_error as repr_for_error,
)
from app.storage.pictures.layered import (
    ImportedLayer as ImportedLayer,
    LayeredPicture as LayeredPicture,
    encode_png as encode_png,
)
from app.storage.pictures.mmap_pixels import (
    move_to_disk as move_to_disk,
    release_pages as release_pages,
)
from app.storage.pictures.parallel import (
    require_memory as require_memory,
    run_parallel as run_parallel,
)
from app.storage.pictures.picture import (
    Picture as Picture,
    decode_mask as decode_mask,
    decode_picture as decode_picture,
    decode_pictures as decode_pictures,
    encode_mask as encode_mask,
)
from app.storage.pictures.programs import refuse_program_file as refuse_program_file
from app.storage.preferences import (
    CHECKER as CHECKER,
    LARGEST_GHOST_STEP as LARGEST_GHOST_STEP,
    LARGEST_SCALE as LARGEST_SCALE,
    MOST_GHOSTS as MOST_GHOSTS,
    SMALLEST_SCALE as SMALLEST_SCALE,
    Preferences as Preferences,
    ThemeName as ThemeName,
    load_preferences as load_preferences,
    make_settings_folder as make_settings_folder,
    save_preferences as save_preferences,
)
from app.storage.project.channel_codecs import IN_FILES as IN_FILES, key_codec as key_codec
from app.storage.project.codecs import (
    TEXT as TEXT,
    VALUE as VALUE,
    Codec as Codec,
    located as located,
)
from app.storage.project_file import (
    load_project as load_project,
    project_digest as project_digest,
    save_project as save_project,
)
from app.storage.scenes.drawings import (
    LAYERED as LAYERED,
    is_layered as is_layered,
    open_layered as open_layered,
    open_merged as open_merged,
    open_picture as open_picture,
    open_pictures as open_pictures,
    read_drawing as read_drawing,
    read_layered as read_layered,
)
from app.storage.scenes.flattening import flatten_layers as flatten_layers
from app.storage.scenes.footage_layers import (
    make_footage_layer as make_footage_layer,
    open_footage_scene as open_footage_scene,
    open_video as open_video,
)
from app.storage.scenes.layers import (
    make_posable_layer as make_posable_layer,
    make_still_layer as make_still_layer,
    make_still_picture as make_still_picture,
    place_as_layer as place_as_layer,
)
from app.storage.scenes.opening import (
    CutOutResult as CutOutResult,
    OpenedScene as OpenedScene,
    cut_picture as cut_picture,
)
from app.storage.thumbnail import (
    draw_thumbnail as draw_thumbnail,
    read_animation_frames as read_animation_frames,
    read_thumbnail as read_thumbnail,
    shrink_picture as shrink_picture,
)
