"""How far correct solutions stay inside each tolerance of ``digital-twin``, and how far wrong ones overshoot.

python tests/benchmarks/calibration/digital-twin.py [--seeds 200] [--mutant-seeds 20] > digital-twin.md
"""

from __future__ import annotations

import recorder

if __name__ == "__main__":
    recorder.main(
        "digital-twin", {"_WANDER": "sync", "_SPREAD": "sync", "_predict": "sync", "_correct": "sync"}
    )
