"""``python -m course``: the same as the ``course`` command."""

import sys

if __name__ == "__main__":
    # ``python -m`` puts the current folder first on sys.path. That is the student's workspace, and a
    # file of theirs called numpy.py or pytest.py must not become part of the trusted side.
    if not sys.flags.safe_path and sys.path:
        del sys.path[0]
    from course.cli import main

    main()
