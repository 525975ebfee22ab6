"""The distortion of an animation as JSON."""

import math
from collections.abc import Mapping
from typing import Any

from app.document import DistortionRange
from app.reports.certification import Report, SegmentReport, Verdict
from app.storage import strict_json
from engine.interpolation import Proof
from engine.maps import Certificate

NAMES = ("k", "sigma_a", "sigma_b")


def format_certification_json(reports: Mapping[str, Report]) -> str:
    """Return the reports by layer name; that of a single layer is not nested."""
    blocks = {name: _block(report) for name, report in reports.items()}
    verdict = Verdict.worst(report.verdict for report in reports.values())
    content = (
        {**_judged(verdict), "layers": blocks} if len(blocks) != 1 else next(iter(blocks.values()))
    )
    return strict_json(content, indent=2)


def _block(report: Report) -> dict[str, Any]:
    keys = [
        {"frame": frame, **_named(own), "certified": own.is_certified} for frame, own in report.keys
    ]
    return {
        **_judged(report.verdict),
        "keys": keys,
        "intervals": [_segment_block(segment) for segment in report.segments],
        "corrected": None if report.corrected is None else _corrected_block(report),
    }


def _corrected_block(report: Report) -> dict[str, Any] | None:
    corrected = report.corrected
    if corrected is None:
        return None
    return {
        "verdict": report.corrected_verdict,
        "frames": corrected.frames,
        "proven": corrected.proven,
        "points": corrected.points,
        "looked_at": corrected.looked_at,
        "left_out": corrected.left_out,
        "sliders": {"frames": corrected.slid, "curbed": corrected.curbed},
        **_named(corrected.reached),
        "between": _named(corrected.between),
        "excess": list(_named(corrected.excess).values()),
        "out_of_reach": [
            {"handle": short.handle, "from": short.first, "to": short.last, "pixels": short.lag}
            for short in corrected.short
        ],
    }


def _judged(verdict: Verdict) -> dict[str, Any]:
    return {"verdict": verdict, "certified": verdict is Verdict.PROVEN}


def _segment_block(segment: SegmentReport) -> dict[str, Any]:
    return {
        "from": segment.first,
        "to": segment.last,
        "verdict": segment.verdict,
        **_named(segment.reached),
        **{f"{name}_keys": value for name, value in _named(segment.keys).items()},
        "error": list(_named(segment.error).values()),
        "correction": segment.correction,
        "proven": {
            **_named(segment.proof),
            "excess": list(_named(segment.excess).values()),
            "never_folds": segment.proof.is_locally_injective,
            "unsettled_frames": list(segment.unsettled),
            "loose_frames": list(segment.loose),
        },
    }


def _named(values: Certificate | DistortionRange | Proof) -> dict[str, float | None]:
    """Return each number by its name; unproven values are None, because JSON has no ∞."""
    return {
        name: value if math.isfinite(value) else None
        for name, value in zip(NAMES, list_numbers(values), strict=True)
    }


def list_numbers(values: Certificate | DistortionRange | Proof) -> tuple[float, float, float]:
    return values.k, values.sigma_a, values.sigma_b
