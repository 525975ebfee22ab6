"""Sounds: decoded, mixed, played, drawn as waveforms, and made into keys of mouths.

In: sound files, cue files, and the sounds of a document.
Out: samples of any range of frames; peaks; keys of mouths. A file that cannot be read raises
`LissomError`. Memory does not grow with the length of a sound beyond its bytes and its peaks.
Imports: `app.document`.
"""

from app.sound.inspection import (
    InspectedSound as InspectedSound,
    inspect_sound as inspect_sound,
    new_sound as new_sound,
)
from app.sound.mixing import SoundMix as SoundMix, common_rate as common_rate
from app.sound.samples import Samples as Samples
from app.sound.soundtrack import (
    Soundtrack as Soundtrack,
    find_soundtrack as find_soundtrack,
    list_sound_notices as list_sound_notices,
)
