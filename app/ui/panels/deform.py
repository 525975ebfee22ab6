"""How far poses may distort the drawing, and how far the one that is shown does."""

from dataclasses import replace

from imgui_bundle import ImVec2, imgui

from app.actions import editing, rebuilding
from app.actions.action import Action, do
from app.document import settings_commands
from app.session import Project, Session
from app.ui.theme import Look, ink
from app.ui.widgets import heading, label, main_button, small, tip
from engine.deform.bounds import Bounds
from engine.deform.certificate import Certificate


def draw(session: Session, look: Look) -> list[Action]:
    """Draw the bounds and what the pose makes of them."""
    project = session.project
    if project is None:
        return []
    actions = _bounds(look, project.document.bounds)
    certificate = shown_certificate(project)
    heading(look, "This pose")
    if certificate is None:
        small(look, "An in-between stays within what its two keys have, whatever the bounds.")
    else:
        _meters(look, certificate, project.document.bounds)
    outside = sum(
        not project.document.bounds.allow(
            k=key.pose.certificate.k,
            sigma_a=key.pose.certificate.sigma_a,
            sigma_b=key.pose.certificate.sigma_b,
        )
        for key in project.document.keys
    )
    heading(look, "All keys")
    keys = "1 key is" if outside == 1 else f"{outside} keys are"
    small(look, f"{keys} outside the bounds." if outside else "Every key is within the bounds.")
    if main_button(look, "Solve all keys again", -1):
        actions.append(do(rebuilding.solve_again))
    tip("Pull every key's handles to their places again, within the bounds of now")
    return actions


def shown_certificate(project: Project) -> Certificate | None:
    """Return what is proven about the pose that is shown; None for an in-between."""
    if project.shown is None or project.shown.pose is None:
        return None
    return project.shown.pose.certificate


def _bounds(look: Look, bounds: Bounds) -> list[Action]:
    heading(look, "Bounds")
    small(look, "No pose goes beyond them, anywhere in the drawing.")
    label(look, "Shear  k")
    changed_k, k = imgui.slider_float("##k", bounds.k, 0.05, 0.98, "at most %.2f")
    tip("Conformal distortion: 0 keeps every angle, 1 is a collapse")
    label(look, "Stretch  σa")
    changed_a, sigma_a = imgui.slider_float(
        "##sigma_a", bounds.sigma_a, 1.05, 20.0, "at most %.2f ×", imgui.SliderFlags_.logarithmic
    )
    tip("The largest stretch in any direction")
    label(look, "Squeeze  σb")
    changed_b, sigma_b = imgui.slider_float(
        "##sigma_b", bounds.sigma_b, 0.02, 0.95, "at least %.2f ×"
    )
    tip("The smallest stretch in any direction")
    if not (changed_k or changed_a or changed_b):
        return []
    chosen = replace(
        bounds,
        k=k if changed_k else bounds.k,
        sigma_a=sigma_a if changed_a else bounds.sigma_a,
        sigma_b=sigma_b if changed_b else bounds.sigma_b,
    )
    return [do(editing.edit, settings_commands.set_bounds(chosen))]


def _meters(look: Look, certificate: Certificate, bounds: Bounds) -> None:
    _meter(look, "k", certificate.k / bounds.k, f"{certificate.k:.3f} of {bounds.k:.2f}")
    stretched = (certificate.sigma_a - 1.0) / (bounds.sigma_a - 1.0)
    _meter(look, "σa", stretched, f"{certificate.sigma_a:.2f} of {bounds.sigma_a:.2f}")
    squeezed = (1.0 - certificate.sigma_b) / (1.0 - bounds.sigma_b)
    _meter(look, "σb", squeezed, f"{certificate.sigma_b:.2f} of {bounds.sigma_b:.2f}")
    if certificate.certified:
        imgui.text_colored(look.palette.good, "Proven: nothing folds, all within the bounds")
    else:
        imgui.text_colored(look.palette.warning, "Not proven within these bounds")


def _meter(look: Look, name: str, share: float, text: str) -> None:
    palette, draw_list = look.palette, imgui.get_window_draw_list()
    label(look, name)
    corner = imgui.get_cursor_screen_pos()
    width, height = imgui.get_content_region_avail().x, imgui.get_frame_height()
    bar = 0.3 * look.em
    low = ImVec2(corner.x, corner.y + height - bar)
    full = ImVec2(corner.x + width, corner.y + height)
    draw_list.add_rect_filled(low, full, ink(palette.raised), bar / 2)
    share = min(max(share, 0.0), 1.0)
    colour = palette.danger if share > 0.98 else palette.warning if share > 0.8 else palette.good
    end = ImVec2(corner.x + max(bar, share * width), corner.y + height)
    draw_list.add_rect_filled(low, end, ink(colour), bar / 2)
    draw_list.add_text(ImVec2(corner.x, corner.y), ink(palette.text), text)
    imgui.dummy(ImVec2(width, height))
