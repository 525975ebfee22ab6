"""Names and explanations of the interpolation methods, for people who draw."""

from itertools import chain
from typing import NamedTuple

from app.document import Baseline, Variant


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
        "Metric", "smooth, bounded", "Stretch and shear stay within those of the keys"
    ),
    Variant.NU: MethodText(
        "Nu (ν)", "even shear", "Shear stays within that of the keys, stretch nearly so"
    ),
    Variant.SCALED_ETA: MethodText(
        "Scaled eta (η)", "bounded", "As eta, held within the limits of the keys"
    ),
    Variant.ETA: MethodText(
        "Eta (η)", "may overshoot", "May leave the limits of the keys; for comparison"
    ),
    Variant.LINEAR: MethodText("Linear", "may fold", "Every point goes straight; for comparison"),
}
# Only for comparison: these methods are not certified, and no drawing is animated with them.
BASELINES: dict[Baseline, MethodText] = {
    Baseline.ARAP: MethodText(
        "ARAP", "may overshoot", "As rigid as possible (Alexa et al. 2000); for comparison"
    ),
    Baseline.FFMP: MethodText(
        "FFMP", "may overshoot", "Ratios of neighbours (Kircher and Garland 2008); for comparison"
    ),
    Baseline.SIG13: MethodText(
        "Chen 2013", "shear bounded", "Flattened metrics (Chen et al. 2013); slow; for comparison"
    ),
    Baseline.HANDLES: MethodText(
        "Straight handles", "wanders", "Handles go straight, poses are solved; slow; for comparison"
    ),
    Baseline.CONFORMAL: MethodText(
        "Conformal",
        "only without shear",
        "For keys without any shear (Weber and Gotsman 2010); for comparison",
    ),
    Baseline.MESH_ETA: MethodText(
        "Eta on the mesh", "nearly bounded", "Scaled eta in each triangle; for comparison"
    ),
}
METHODS: dict[Variant | Baseline, MethodText] = dict(chain(VARIANTS.items(), BASELINES.items()))
