"""`lissom certify`: the distortion of an animation."""

import argparse
import math
from collections.abc import Mapping, Sequence
from typing import Any

from app.cli.console import print_line, print_notices
from app.document import DistortionRange, clip_of, motion_notices
from app.errors import shortened
from app.motion import find_parent_motion
from app.reports import Report, SegmentReport, Verdict, certify_clip
from app.storage import load_project, strict_json
from engine.interpolation import Proof
from engine.maps import Certificate

NAMES = ("k", "sigma_a", "sigma_b")
EXITS = {Verdict.PROVEN: 0, Verdict.MEASURED: 3, Verdict.OVER: 1}
# Words of the table.
WORDS = {Verdict.PROVEN: "proven", Verdict.MEASURED: "MEASURED ONLY", Verdict.OVER: "OVER"}


def run(arguments: argparse.Namespace) -> int:
    """Print the report of a project."""
    document = load_project(arguments.project)
    print_notices(motion_notices(document))
    reports = {
        layer.name: certify_clip(
            clip_of(document, layer.id), arguments.variant, find_parent_motion(document, layer.id)
        )
        for layer in document.layers
        if not layer.still
    }
    if arguments.json:
        print_line(_as_json(reports))
    else:
        # For a single layer the table suffices.
        parts = [_overview(reports)] if len(reports) != 1 else []
        print_line(
            "\n\n".join([*parts, *(_tables(reports) if arguments.details or not parts else [])])
        )
    return EXITS[_verdict(reports)]


def _verdict(reports: Mapping[str, Report]) -> Verdict:
    return Verdict.worst(report.verdict for report in reports.values())


def _as_json(reports: Mapping[str, Report]) -> str:
    blocks = {name: _block(report) for name, report in reports.items()}
    content = (
        {**_judged(_verdict(reports)), "layers": blocks}
        if len(blocks) != 1
        else next(iter(blocks.values()))
    )
    return strict_json(content, indent=2)


def _tables(reports: Mapping[str, Report]) -> list[str]:
    if len(reports) == 1:
        return [_as_table(report) for report in reports.values()]
    return [f"{shortened(name)}\n{_as_table(report)}" for name, report in reports.items()]


def _overview(reports: Mapping[str, Report]) -> str:
    """Return the verdict of a scene, and a line for each layer: its worst values, and where."""
    if not reports:
        return "All in all: proven: all that is there stands still."
    verdict, count = _verdict(reports), len(reports)
    worst = sum(report.verdict is verdict for report in reports.values())
    whole = {
        Verdict.PROVEN: f"all {count} layers are proven to keep their bounds at every moment",
        Verdict.MEASURED: f"no in-between folds; that bounds are kept is measured only of {worst} "
        f"of {count} layers",
        Verdict.OVER: f"{worst} of {count} layers are beyond their bounds, or may fold",
    }
    lines = [f"All in all: {WORDS[verdict]}: {whole[verdict]}."]
    shown = [(shortened(name), report) for name, report in reports.items()]
    width = max(len(name) for name, _ in shown)
    lines.append(_line("", NAMES, width=width, cell=9))
    for name, report in shown:
        cells = [f"{value:.4f}" for value in _numbers(report.reached)]
        where = ", ".join(_where(report))
        told = f"{WORDS[report.verdict]}{f' at {where}' if where else ''}"
        lines.append(_line(name, cells, told, width=width, cell=9))
    return "\n".join([*lines, "Each layer's keys and intervals: --details."])


def _where(report: Report) -> list[str]:
    """Return the places with the layer's verdict; none if it is proven."""
    if report.verdict is Verdict.PROVEN:
        return []
    is_over = report.verdict is Verdict.OVER
    found = [f"key {frame}" for frame, own in report.keys if is_over and not own.is_certified]
    found += [
        f"{each.first} to {each.last}" for each in report.segments if each.verdict is report.verdict
    ]
    return found + ["tracks"] * (report.corrected_verdict is report.verdict)


def _block(report: Report) -> dict[str, Any]:
    keys = [
        {"frame": frame, **_named(own), "certified": own.is_certified} for frame, own in report.keys
    ]
    return {
        **_judged(report.verdict),
        "keys": keys,
        "intervals": [_interval_block(interval) for interval in report.segments],
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


def _interval_block(interval: SegmentReport) -> dict[str, Any]:
    return {
        "from": interval.first,
        "to": interval.last,
        "verdict": interval.verdict,
        **_named(interval.reached),
        **{f"{name}_keys": value for name, value in _named(interval.keys).items()},
        "error": list(_named(interval.error).values()),
        "correction": interval.correction,
        "proven": {
            **_named(interval.proof),
            "excess": list(_named(interval.excess).values()),
            "never_folds": interval.proof.is_locally_injective,
            "unsettled_frames": list(interval.unsettled),
            "loose_frames": list(interval.loose),
        },
    }


def _named(values: Certificate | DistortionRange | Proof) -> dict[str, float | None]:
    """Return each number by its name; unproven values are None, because JSON has no ∞."""
    return {
        name: value if math.isfinite(value) else None
        for name, value in zip(NAMES, _numbers(values), strict=True)
    }


def _numbers(values: Certificate | DistortionRange | Proof) -> tuple[float, float, float]:
    return values.k, values.sigma_a, values.sigma_b


def _as_table(report: Report) -> str:
    lines = [_line("", NAMES)]
    for frame, own in report.keys:
        cells = [f"{value:.4f}" for value in _numbers(own)]
        lines.append(
            _line(f"key {frame}", cells, "certified" if own.is_certified else "NOT CERTIFIED")
        )
    for interval in report.segments:
        lines += _interval_lines(interval)
    lines += [
        f"{cycle.description.capitalize()} repeat"
        f"{'' if cycle.until is None else f' until frame {cycle.until}'}: every repeat is the same "
        "motion, told once."
        for cycle in report.cycles
    ]
    lines += _corrected_lines(report)
    lines.append(
        "In brackets: the worse of the two keyframes; of what is proven, how far that is beyond it"
        " (or beyond the layer's bounds, where handles stay or the motion passes through a key)."
    )
    lines.append(f"All in all: {WORDS[report.verdict]}.")
    largest = max((interval.correction for interval in report.segments), default=0.0)
    if largest > 0:
        lines.append(
            f"Around holes the in-betweens are stretched and turned by up to {largest:.2%} to "
            "close, and Equation (13) of the metric variant holds by least squares only; what is "
            "kept of the bounds is proven above."
        )
    return "\n".join(lines)


def _corrected_lines(report: Report) -> list[str]:
    """Return the report of frames in which tracks and springs move handles."""
    corrected = report.corrected
    if corrected is None or not (corrected.frames or corrected.left_out):
        return []
    reached = zip(_numbers(corrected.reached), ("+", "+", "-"), corrected.excess, strict=True)
    cells = [f"{value:.4f} ({sign}{by:.4f})" for value, sign, by in reached]
    lines = [_line("tracks", cells, WORDS[report.corrected_verdict])]
    lines.append(
        f"Tracks and springs move handles in {corrected.frames} frames; {corrected.proven} of them "
        f"are proven. Halfway between two frames the drawing is measured, at {corrected.points:,} "
        "points of the outline."
    )
    if corrected.left_out:
        every = corrected.looked_at + corrected.left_out
        lines.append(
            f"Tracks and springs act in {every:,} frames, repeats told once. "
            f"{corrected.looked_at:,} of them were looked at, at equal steps."
        )
    lines += [
        f"{shortened(repr(short.handle))} is out of reach of its track by up to {short.lag:.1f} px "
        "in frame"
        f"{f's {short.first} to {short.last}' if short.last > short.first else f' {short.first}'}."
        for short in corrected.short
    ]
    return lines


def _interval_lines(interval: SegmentReport) -> list[str]:
    """Return the reached values of a segment, the proven values, and unproven frames."""
    reached = zip(_numbers(interval.reached), interval.keys, strict=True)
    proven = zip(_numbers(interval.proof), ("+", "+", "-"), interval.excess, strict=True)
    lines = [
        _line(
            f"{interval.first} to {interval.last}",
            [f"{value:.4f} ({keys:.4f})" for value, keys in reached],
            "within" if interval.is_within else "OVER",
        ),
        _line(
            "  proven",
            [f"{value:.4f} ({sign}{by:.4f})" for value, sign, by in proven],
            "MAY FOLD" if interval.may_fold else WORDS[interval.verdict],
        ),
    ]
    for what, found in (("  may fold", interval.unsettled), ("  less tight", interval.loose)):
        if found:
            frames = ", ".join(map(str, found))
            lines.append(f"{what:<16} frame{'s' * (len(found) > 1)} {frames}")
    return lines


def _line(
    name: str, cells: Sequence[str], verdict: str = "", *, width: int = 16, cell: int = 18
) -> str:
    told = " ".join(f"{each:>{cell}}" for each in cells)
    return f"{name:<{width}} {told}  {verdict}".rstrip()
