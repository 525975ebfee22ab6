"""Motions of chains, such as snakes, fish, tails and scarves."""

from app.rigging.motions.curves import EIGHTHS
from app.rigging.motions.motion import Motion
from app.rigging.motions.waves import Wave
from app.texts import _

SLITHER = Motion(
    name="slither",
    label=_("Slither"),
    hint=_("A wave runs from the head to the tail"),
    seconds=1.5,
    phases=EIGHTHS,
    templates={"chain": Wave(degrees=32, waves=1.0, first=0.6)},
)

WAG = Motion(
    name="wag",
    label=_("Wag"),
    hint=_("The chain is held at its first joint and swings, its tip last"),
    seconds=1.0,
    phases=EIGHTHS,
    templates={"chain": Wave(degrees=34, waves=0.35, first=0.15, held=True)},
)
