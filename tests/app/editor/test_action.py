"""Actions: verbs with what they are done with."""

from app.editor import do


def test_an_action_keeps_what_it_is_given_by_name():
    done = []

    def verb(session, first, *, second=0):
        done.append((session, first, second))

    do(verb, 1, second=2).apply("session")
    assert done == [("session", 1, 2)]
    assert do(verb, 1, second=2) == do(verb, 1, second=2)
