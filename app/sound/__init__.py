"""Sounds: decoded, mixed, played, drawn as waveforms, and made into keys of mouths.

In: sound files, cue files, and the sounds of a document.
Out: samples of any range of frames; peaks; keys of mouths. A file that cannot be read raises
`LissomError`. Memory does not grow with the length of a sound beyond its bytes and its peaks.
Imports: `app.document`.
"""

from app.sound.cues import (
    CUE_SUFFIXES as CUE_SUFFIXES,
    LARGEST_CUES as LARGEST_CUES,
    parse_cues as parse_cues,
)
from app.sound.device import open_device as open_device
from app.sound.inspection import (
    PEAKS_PER_SECOND as PEAKS_PER_SECOND,
    SUFFIXES as SUFFIXES,
    InspectedSound as InspectedSound,
    inspect_sound as inspect_sound,
    new_sound as new_sound,
)
from app.sound.mixing import SoundMix as SoundMix, common_rate as common_rate
from app.sound.mouths import (
    Response as Response,
    cues_of_volume as cues_of_volume,
    follow_volume as follow_volume,
    guess_drawings as guess_drawings,
    make_mouth_keys as make_mouth_keys,
    make_volume_values as make_volume_values,
)
from app.sound.player import SoundPlayer as SoundPlayer
from app.sound.samples import Samples as Samples
from app.sound.soundtrack import (
    Soundtrack as Soundtrack,
    find_soundtrack as find_soundtrack,
    list_sound_notices as list_sound_notices,
)
from app.sound.stream import (
    PlayedRange as PlayedRange,
    stream_part as stream_part,
    stream_range as stream_range,
)
