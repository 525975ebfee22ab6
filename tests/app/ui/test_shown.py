"""What the lists beside the README's pictures say is really found in the window."""

import pytest

from tests.readme.shown import shown_in, shown_now


@pytest.mark.usefixtures("bar")
def test_the_window_shows_the_menus_tabs_and_tools_of_its_tables(window):
    assert shown_in(window) == shown_now()
