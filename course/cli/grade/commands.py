"""``course grade``: an instructor's commands for a class. They need a checkout."""

from __future__ import annotations

from course.cli.frame.registry import COMMANDS, group
from course.cli.grade.changing import assign, late, log, override, rerun, salvage, similar
from course.cli.grade.export import export
from course.cli.grade.running import explain, run

app = group(COMMANDS["grade"].summary)


@app.callback()
def _group() -> None:
    """Grade a class: hidden checks, protected workers, one gradebook."""


for _command, _example in (
    (run, "run submissions --exercise integrators --out grades -j 2"),
    (explain, "explain grades ada integrators"),
    (assign, "assign grades ada homework.py --reason 'she named it so'"),
    (rerun, "rerun grades --dry-run"),
    (override, "override grades ada integrators --score 80 --reason 'oral exam'"),
    (late, "late grades --policy late.toml"),
    (log, "log grades"),
    (similar, "similar grades"),
    (export, "export grades --format canvas --roster class.csv --assignment integrators=4711"),
    (salvage, "salvage grades --to grades-salvaged"),
):
    app.command(_command.__name__, epilog=f"Example: course grade {_example}")(_command)
