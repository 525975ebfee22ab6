"""The distortion of an animation as a table."""

from collections.abc import Mapping, Sequence
from math import expm1

from app.document import Cycle
from app.errors import shortened
from app.reports.certification import Report, SegmentReport, Verdict
from app.reports.certification_json import NAMES, list_numbers
from app.reports.corrected_frames import CorrectedReport
from app.texts import _, ngettext

WORDS = {
    Verdict.PROVEN: _("proven"),
    Verdict.MEASURED: _("MEASURED ONLY"),
    Verdict.OVER: _("OVER"),
}


def format_certification_table(reports: Mapping[str, Report], *, details: bool) -> str:
    """Return the table of a single layer; of a scene an overview, and the tables as details."""
    if len(reports) == 1:
        return "".join(map(_as_table, reports.values()))
    tables = [f"{shortened(name)}\n{_as_table(report)}" for name, report in reports.items()]
    return "\n\n".join([_overview(reports), *(tables if details else [])])


def _overview(reports: Mapping[str, Report]) -> str:
    """Return the verdict of a scene, and a line for each layer: its worst values, and where."""
    if not reports:
        return _("Overall: proven. Nothing in this project moves.")
    verdict = Verdict.worst(report.verdict for report in reports.values())
    whole = {
        Verdict.PROVEN: _("All {count} layers are proven to keep their limits at every moment."),
        Verdict.MEASURED: _(
            "No in-between folds. Layers whose limits are measured only: {worst} of {count}."
        ),
        Verdict.OVER: _("Layers that exceed their limits, or may fold: {worst} of {count}."),
    }[verdict].format(
        count=len(reports), worst=sum(report.verdict is verdict for report in reports.values())
    )
    shown = [(shortened(name), report) for name, report in reports.items()]
    width = max(len(name) for name, _report in shown)
    lines = [f"{_all_in_all(verdict)} {whole}", _line("", NAMES, width=width, cell=9)]
    for name, report in shown:
        cells = [f"{value:.4f}" for value in list_numbers(report.reached)]
        word, places = WORDS[report.verdict], ", ".join(_places(report))
        if places:
            word = _("{verdict} at {places}").format(verdict=word, places=places)
        lines.append(_line(name, cells, word, width=width, cell=9))
    return "\n".join([*lines, _("Add --details to see the keys and segments of each layer.")])


def _all_in_all(verdict: Verdict) -> str:
    return _("Overall: {verdict}.").format(verdict=WORDS[verdict])


def _places(report: Report) -> list[str]:
    """Return the places with the layer's verdict; none if it is proven."""
    if report.verdict is Verdict.PROVEN:
        return []
    is_over = report.verdict is Verdict.OVER
    found = [_key(frame) for frame, own in report.keys if is_over and not own.is_certified]
    found += [_frames(each) for each in report.segments if each.verdict is report.verdict]
    if report.corrected is not None and report.corrected_verdict is report.verdict:
        found.append(_name(report.corrected))
    return found


def _name(corrected: CorrectedReport) -> str:
    return _("sliders") if corrected.slid else _("tracks")


def _key(frame: int) -> str:
    return _("key {frame}").format(frame=frame)


def _frames(segment: SegmentReport) -> str:
    return _("{first} to {last}").format(first=segment.first, last=segment.last)


def _as_table(report: Report) -> str:
    lines = [_line("", NAMES)]
    for frame, own in report.keys:
        cells = [f"{value:.4f}" for value in list_numbers(own)]
        word = _("certified") if own.is_certified else _("NOT CERTIFIED")
        lines.append(_line(_key(frame), cells, word))
    for segment in report.segments:
        lines += _segment_lines(segment)
    lines += [_cycle_line(cycle) for cycle in report.cycles]
    lines += _corrected_lines(report)
    lines.append(
        _(
            "In brackets beside a measured value is the worse value of the two keys. In "
            "brackets beside a proven value is its excess over that value. With auto-pins or "
            "smooth tangents, the excess is over the layer's limits."
        )
    )
    lines.append(_all_in_all(report.verdict))
    largest = max((segment.correction for segment in report.segments), default=0.0)
    if largest > 0:
        lines.append(
            _(
                "To close around holes, the in-betweens are stretched and rotated by up to "
                "{largest:.2%}. Equation (13) of the metric variant is met by least squares "
                "only. The proven values include this correction."
            ).format(largest=largest)
        )
    return "\n".join(lines)


def _cycle_line(cycle: Cycle) -> str:
    if cycle.until is None:
        text = _(
            "Frames {first} to {last} repeat. Every repeat is the same motion and is listed once."
        )
    else:
        text = _(
            "Frames {first} to {last} repeat until frame {until}. Every repeat is the same "
            "motion and is listed once."
        )
    return text.format(first=cycle.first, last=cycle.last, until=cycle.until)


def _corrected_lines(report: Report) -> list[str]:
    """Return the report of frames in which tracks and springs move handles."""
    corrected = report.corrected
    if corrected is None or not (corrected.frames or corrected.left_out):
        return []
    reached = zip(list_numbers(corrected.reached), ("+", "+", "-"), corrected.excess, strict=True)
    cells = [f"{value:.4f} ({sign}{by:.4f})" for value, sign, by in reached]
    lines = [_line(_name(corrected), cells, WORDS[report.corrected_verdict])]
    lines.append(
        _(
            "Sliders, tracks and springs change {frames} frames; {proven} of them are proven. "
            "Halfway between two frames the drawing is measured, at {points:,} points of the "
            "outline."
        ).format(frames=corrected.frames, proven=corrected.proven, points=corrected.points)
    )
    if corrected.slid:
        lines.append(
            _(
                "Sliders keep the layer's limits by construction. Their frames are measured, not "
                "proven. The limits scale the blend of their poses by up to {curbed:.0%} in places."
            ).format(curbed=expm1(corrected.curbed))
        )
    if corrected.left_out:
        lines.append(
            _(
                "They act in {count:,} frames; a repeat counts once. {examined:,} of them were "
                "examined, at equal steps."
            ).format(count=corrected.looked_at + corrected.left_out, examined=corrected.looked_at)
        )
    for short in corrected.short:
        text = (
            _("{handle} misses the target of its track by up to {lag:.1f} px in frame {first}.")
            if short.first == short.last
            else _(
                "{handle} misses the target of its track by up to {lag:.1f} px in frames {first} "
                "to {last}."
            )
        )
        lines.append(
            text.format(
                handle=shortened(repr(short.handle)),
                lag=short.lag,
                first=short.first,
                last=short.last,
            )
        )
    return lines


def _segment_lines(segment: SegmentReport) -> list[str]:
    """Return the reached values of a segment, the proven values, and unproven frames."""
    reached = zip(list_numbers(segment.reached), segment.keys, strict=True)
    proven = zip(list_numbers(segment.proof), ("+", "+", "-"), segment.excess, strict=True)
    lines = [
        _line(
            _frames(segment),
            [f"{value:.4f} ({keys:.4f})" for value, keys in reached],
            _("within") if segment.is_within else _("OVER"),
        ),
        _line(
            f"  {_('proven')}",
            [f"{value:.4f} ({sign}{by:.4f})" for value, sign, by in proven],
            _("MAY FOLD") if segment.may_fold else WORDS[segment.verdict],
        ),
    ]
    for name, found in ((_("may fold"), segment.unsettled), (_("less tight"), segment.loose)):
        if found:
            frames = ngettext("frame {frames}", "frames {frames}", len(found))
            lines.append(f"{f'  {name}':<16} {frames.format(frames=', '.join(map(str, found)))}")
    return lines


def _line(
    name: str, cells: Sequence[str], verdict: str = "", *, width: int = 16, cell: int = 18
) -> str:
    row = " ".join(f"{each:>{cell}}" for each in cells)
    return f"{name:<{width}} {row}  {verdict}".rstrip()
