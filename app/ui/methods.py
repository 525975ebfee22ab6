"""Names and explanations of the interpolation methods, for people who draw."""

from itertools import chain
from typing import NamedTuple

from app.document import Baseline, Variant
from app.texts import _


class MethodText(NamedTuple):
    name: str
    trait: str
    what: str

    @property
    def title(self) -> str:
        """The name with its trait, for lists."""
        return f"{self.name} – {self.trait}"


VARIANTS: dict[Variant, MethodText] = {
    Variant.METRIC: MethodText(
        _("Metric"), _("smooth, bounded"), _("Stretch and shear stay within those of the keys")
    ),
    Variant.NU: MethodText(
        _("Nu (ν)"), _("even shear"), _("Shear stays within that of the keys, stretch nearly so")
    ),
    Variant.SCALED_ETA: MethodText(
        _("Scaled eta (η)"), _("bounded"), _("As eta, held within the limits of the keys")
    ),
    Variant.ETA: MethodText(
        _("Eta (η)"), _("may overshoot"), _("May leave the limits of the keys; for comparison")
    ),
    Variant.LINEAR: MethodText(
        _("Linear"), _("may fold"), _("Every point moves in a straight line; for comparison")
    ),
}
# Only for comparison: these methods are not certified, and no drawing is animated with them.
BASELINES: dict[Baseline, MethodText] = {
    Baseline.ARAP: MethodText(
        _("ARAP"), _("may overshoot"), _("As rigid as possible (Alexa et al. 2000); for comparison")
    ),
    Baseline.FFMP: MethodText(
        _("FFMP"),
        _("may overshoot"),
        _("Ratios of neighbours (Kircher and Garland 2008); for comparison"),
    ),
    Baseline.SIG13: MethodText(
        _("Chen 2013"),
        _("shear bounded"),
        _("Flattened metrics (Chen et al. 2013); slow; for comparison"),
    ),
    Baseline.HANDLES: MethodText(
        _("Straight handles"),
        _("wanders"),
        _("Handles move in straight lines, poses are solved; slow; for comparison"),
    ),
    Baseline.CONFORMAL: MethodText(
        _("Conformal"),
        _("only without shear"),
        _("For keys without any shear (Weber and Gotsman 2010); for comparison"),
    ),
    Baseline.MESH_ETA: MethodText(
        _("Eta on the mesh"), _("nearly bounded"), _("Scaled eta in each triangle; for comparison")
    ),
}
METHODS: dict[Variant | Baseline, MethodText] = dict(chain(VARIANTS.items(), BASELINES.items()))
