"""The variants by name."""

from collections.abc import Mapping

from engine.interpolation.blends.blend import Blend
from engine.interpolation.blends.eta import EtaBlend, ScaledEtaBlend
from engine.interpolation.blends.linear import LinearBlend
from engine.interpolation.blends.metric import MetricBlend
from engine.interpolation.blends.nu import NuBlend
from engine.variant import Variant

BLENDS: Mapping[Variant, type[Blend]] = {
    Variant.METRIC: MetricBlend,
    Variant.NU: NuBlend,
    Variant.SCALED_ETA: ScaledEtaBlend,
    Variant.ETA: EtaBlend,
    Variant.LINEAR: LinearBlend,
}
