"""What is added to a blend: by which periods around holes close, and by which handles stay.

In: in-betweens, and what they lack.
Out: functions that are added as series in time; of handles that stay, in a room of their own.
Imports: `engine.deform.correction`, `engine.interpolation.series`, `engine.maps`, `engine.paths`.
"""

from engine.interpolation.added.closing import (
    Closing as Closing,
    HoleCloser as HoleCloser,
    Moduli as Moduli,
)
