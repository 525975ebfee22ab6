"""`lissom certify`: how far an animation distorts its drawing."""

import argparse
import json
import math
from collections.abc import Mapping
from typing import Any

from app.document import clip_of
from app.reports import IntervalReport, Report, certify_clip
from app.storage import load_project


def run(arguments: argparse.Namespace) -> int:
    """Print the report of a project."""
    document = load_project(arguments.project)
    reports = {
        figure.name: certify_clip(clip_of(document, figure.id), arguments.variant)
        for figure in document.figures
        if not figure.still
    }
    print(_as_json(reports) if arguments.json else _as_tables(reports))
    return 0 if all(report.certified for report in reports.values()) else 1


def _as_json(reports: Mapping[str, Report]) -> str:
    blocks = {name: _block(report) for name, report in reports.items()}
    (first, *others) = blocks.values()
    content = {"figures": blocks} if others else first
    return json.dumps(content, indent=2)


def _as_tables(reports: Mapping[str, Report]) -> str:
    if len(reports) == 1:
        return "".join(map(_as_table, reports.values()))
    return "\n\n".join(f"{name}\n{_as_table(report)}" for name, report in reports.items())


def _block(report: Report) -> dict[str, Any]:
    return {
        "certified": report.certified,
        "keys": [
            {
                "frame": frame,
                "k": _finite(certificate.k),
                "sigma_a": certificate.sigma_a,
                "sigma_b": certificate.sigma_b,
                "certified": certificate.certified,
            }
            for frame, certificate in report.keys
        ],
        "intervals": [
            {
                "from": interval.first,
                "to": interval.last,
                "k": interval.reached.k,
                "sigma_a": interval.reached.sigma_a,
                "sigma_b": interval.reached.sigma_b,
                "k_keys": interval.keys.k,
                "sigma_a_keys": interval.keys.sigma_a,
                "sigma_b_keys": interval.keys.sigma_b,
                "correction": interval.correction,
                "proven": _proof_of(interval),
            }
            for interval in report.intervals
        ],
    }


def _proof_of(interval: IntervalReport) -> dict[str, Any]:
    proof, excess = interval.proof, interval.excess
    return {
        "k": _finite(proof.k),
        "sigma_a": _finite(proof.sigma_a),
        "sigma_b": proof.sigma_b,
        "excess": [_finite(excess.k), _finite(excess.sigma_a), excess.sigma_b],
        "never_folds": proof.never_folds,
        "unsettled_frames": list(interval.unsettled),
    }


def _finite(value: float) -> float | None:
    """Return the number, or None (JSON null) where nothing is proven: JSON has no infinity."""
    return value if math.isfinite(value) else None


def _proof_lines(interval: IntervalReport) -> list[str]:
    """Return what is proven of an interval, and where it is not."""
    proof, excess = interval.proof, interval.excess
    pairs = zip((proof.k, proof.sigma_a, proof.sigma_b), ("+", "+", "-"), excess, strict=True)
    figures = " ".join(f"{f'{value:.4f} ({sign}{by:.4f})':>18}" for value, sign, by in pairs)
    verdict = "NOT PROVEN" if interval.may_fold else "never folds"
    lines = [f"{'  proven':<16} {figures}  {verdict}"]
    if interval.unsettled:
        frames = ", ".join(map(str, interval.unsettled))
        what = "  may fold" if interval.may_fold else "  less tight"
        lines.append(f"{what:<16} frame{'s' * (len(interval.unsettled) > 1)} {frames}")
    return lines


def _as_table(report: Report) -> str:
    lines = [f"{'':<16} {'k':>18} {'sigma_a':>18} {'sigma_b':>18}"]
    for frame, own in report.keys:
        verdict = "certified" if own.certified else "NOT CERTIFIED"
        figures = " ".join(f"{value:>18.4f}" for value in (own.k, own.sigma_a, own.sigma_b))
        lines.append(f"{f'key {frame}':<16} {figures}  {verdict}")
    for interval in report.intervals:
        pairs = (
            (interval.reached.k, interval.keys.k),
            (interval.reached.sigma_a, interval.keys.sigma_a),
            (interval.reached.sigma_b, interval.keys.sigma_b),
        )
        figures = " ".join(f"{f'{reached:.4f} ({own:.4f})':>18}" for reached, own in pairs)
        verdict = "within" if interval.is_within else "OVER"
        lines.append(f"{f'{interval.first} to {interval.last}':<16} {figures}  {verdict}")
        lines += _proof_lines(interval)
    lines.append(
        "In brackets: the worse of the two keyframes; of what is proven, how far that is beyond it"
        " (or beyond the figure's bounds, where the motion passes through a key)."
    )
    largest = max((interval.correction for interval in report.intervals), default=0.0)
    if largest > 0:
        lines.append(
            f"Around holes the in-betweens are stretched and turned by up to {largest:.2%} to "
            "close; what is kept of the bounds is proven above."
        )
    return "\n".join(lines)
