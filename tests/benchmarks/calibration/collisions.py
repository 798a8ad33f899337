"""How far correct solutions stay inside each tolerance of ``collisions``, and how far wrong ones overshoot.

python tests/benchmarks/calibration/collisions.py [--seeds 200] [--mutant-seeds 20] > collisions.md
"""

from __future__ import annotations

import recorder

if __name__ == "__main__":
    recorder.main("collisions")
