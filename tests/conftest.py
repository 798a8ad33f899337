"""Lets tests import what they share (``tests.contracts.levels``), however pytest is started.

The folder goes last on the path: a package that is installed is still the one under test.
"""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))
