"""What the program prints now, beside what it printed before and what theory says."""

from course.scoring import kit

#: What the program as it was handed out says, once it no longer stops: a test runs it.
BEFORE = ("9.999 m", "1.99 s", "10.00 m", "10.00 m", "0.0055 m", "0.0055 m")
#: And what is true: sqrt(2 h/g), in whole steps; balls of 1 m that bounce when they touch; explicit Euler's
#: swing grows by 1 + (h omega)^2/2 a step, and semi-implicit Euler is ahead by half a step times omega.
THEORY = ("10.000 m", "1.43 s", "10.00 m", "12.00 m", "about 0.088 m", "about 0.005 m")


def report(submission):
    """One table, a row for each line that the program prints."""
    return kit.Report(
        title="Before and after",
        sections=(kit.guarded_section("What the program says", lambda: _table(submission)),),
    )


def _table(submission):
    said = [kit.as_tuple(pair, ("what", "how much")) for pair in kit.as_list(submission.call("summary"))]
    rows = tuple(
        (str(what), before, str(now), truth)
        for (what, now), before, truth in zip(said, BEFORE, THEORY, strict=False)
    )
    return kit.Section(
        "What the program says",
        'As it was handed out it stopped with a TypeError and said nothing at all. "Before" is what it would '
        "have said with that one fault fixed.\n\n"
        "Two things to look at. The balls end up 8 cm short of 12 m: the program looks once a step and finds "
        "them 4 cm inside each other, which is what the lessons on contact are about. And the last number "
        "has not changed. Semi-implicit Euler runs half a step ahead of the exact motion. It was compared "
        "with the exact position one step later, so it seemed half a step behind: an error of the same size. "
        "A number that looks right proves little.",
        columns=("what", "before", "now", "true"),
        rows=rows,
    )
