"""The frame guard: a panel that raises is reported, and the window lives on."""

from collections.abc import Callable

from imgui_bundle import imgui

Tell = Callable[[str, Exception], None]


def allow_recovery() -> None:
    """Let Dear ImGui close what a broken panel left open, instead of asserting in every frame."""
    io = imgui.get_io()
    io.config_error_recovery = True
    io.config_error_recovery_enable_assert = False
    io.config_error_recovery_enable_tooltip = False
    io.config_error_recovery_enable_debug_log = True


def guard(what: str, draw: Callable[[], None], report: Tell) -> None:
    """Draw a part of the window; where that fails, restore ImGui's stacks and report it.

    Parameters
    ----------
    what : str
        The part's name, for the message.
    draw : callable
    report : callable
        Takes a sentence, and what was raised.
    """
    state = imgui.internal.ErrorRecoveryState()
    imgui.internal.error_recovery_store_state(state)
    try:
        draw()
    except Exception as error:  # noqa: BLE001 - the frame guard: the window must live on
        imgui.internal.error_recovery_try_to_recover_state(state)
        report(f"{what} could not be drawn: {error}", error)
