from app.actions import viewing


def test_welcome_offers_the_samples(window):
    window.frames(8)

    def play(robot):
        robot.set_ref("Welcome")
        assert robot.item_exists("**/sample Giraffe")

    window.run(play)


def test_theme_and_scale_change_at_once(window):
    before = window.picture()
    viewing.toggle_theme(window.session)
    window.frames(2)
    assert window.picture() != before
    text_size = window.text_height()
    viewing.scale_up(window.session)
    window.frames(2)
    assert window.text_height() > text_size


def test_changing_the_theme_changes_no_size(window):
    height = window.status_height()
    for _ in range(4):
        viewing.scale_up(window.session)
        window.frames(2)
        viewing.scale_down(window.session)
        viewing.toggle_theme(window.session)
        window.frames(2)
    assert window.status_height() == height


def test_f1_opens_the_sheet_of_keys(window):
    window.run(lambda robot: robot.key_press(int(window.Key.f1)))
    assert window.session.dialog is not None
    window.run(lambda robot: robot.key_press(int(window.Key.escape)))
    assert window.session.dialog is None
