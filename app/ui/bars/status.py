"""The status bar."""

from typing import NamedTuple

from imgui_bundle import ImColor, imgui, imspinner

from app.document import Extremes
from app.editor import Action, Project, Session
from app.ui.style import Look, tip

WORDS = {"k": "Shear", "σa": "Stretch", "σb": "Squeeze"}
SLOW = 0.3  # seconds after which a job is told of; shorter ones would only flicker


class Fact(NamedTuple):
    """Something at the right of the status bar."""

    text: str
    what: str  # in its tooltip
    warns: bool = False


def draw_status(session: Session, look: Look) -> list[Action]:
    """Draw the status bar: what goes on, and how the project and the window are."""
    slow = session.jobs.running_for(SLOW)
    if slow:
        _spinner(look)
        imgui.text_unformatted(f"{slow[0]}…")
    else:
        imgui.text_disabled(session.hint or "Ready")
    gap = 1.6 * look.em
    told = facts(session)
    width = sum(imgui.calc_text_size(fact.text).x + gap for fact in told)
    imgui.same_line(imgui.get_window_width() - width + gap - look.em)
    for fact in told:
        imgui.text_colored(look.palette.warning if fact.warns else look.palette.dim, fact.text)
        tip(fact.what)
        imgui.same_line(0, gap)
    imgui.new_line()
    return []


def facts(session: Session) -> list[Fact]:
    """Return what the right end of the bar says."""
    facts = []
    project = session.project
    if project is not None:
        distortion = _distortion(project)
        facts += [distortion] if distortion else []
        count = len(project.figure.handles)
        facts.append(Fact(f"{count} handle{'' if count == 1 else 's'}", "Handles of this drawing"))
    if session.solver_seconds:
        milliseconds = 1e3 * session.solver_seconds
        facts.append(Fact(f"pose {milliseconds:.0f} ms", "What the last step of a pose took"))
    if project is not None and project.playhead.since is not None:
        facts.append(Fact(f"{imgui.get_io().framerate:.0f} fps", "Frames drawn in a second"))
    return facts


def _distortion(project: Project) -> Fact | None:
    """Return the largest distortion that is shown, of the kind that is nearest to its bound."""
    shown, curves = project.puppet.shown, project.curves.value
    if shown is None:
        return None
    if shown.pose is not None:
        extremes = Extremes.of(shown.pose)
    elif curves is not None and curves.clip == project.clip:
        extremes = curves.extremes_at(shown.frame)
    else:
        return None
    uses = extremes.uses(project.figure.bounds)
    most = max(uses, key=lambda use: use.share)
    return Fact(
        f"{WORDS[most.name]} {most.value:.2f}, limit {most.bound:.2f}",
        "\n".join(
            ["Largest distortion of the whole shape, and its limit", ""]
            + [
                f"{WORDS[use.name]} ({use.name}) {use.value:.3f}, limit {use.bound:.3f}"
                for use in uses
            ]
        ),
        warns=most.is_all,
    )


def _spinner(look: Look) -> None:
    colour = ImColor(look.palette.accent)
    imspinner.spinner_ang(
        "##busy", 0.35 * look.em, 0.14 * look.em, colour, ImColor(0, 0, 0, 0), speed=6.0, angle=4.5
    )
    imgui.same_line()
