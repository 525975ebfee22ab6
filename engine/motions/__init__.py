"""Ready motions: what a body does over a cycle, for whatever body it is.

In: the joints of a drawing by name, and a motion with its parameters.
Out: where each joint is at each moment.
Imports: `engine.arrays`, `engine.errors`.
"""

from engine.motions.kinds import KINDS as KINDS, Kind as Kind, kind_named as kind_named
