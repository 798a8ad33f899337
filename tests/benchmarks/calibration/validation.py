"""How far correct solutions stay inside each tolerance of ``validation``, and how far wrong ones overshoot.

python tests/benchmarks/calibration/validation.py [--seeds 200] [--mutant-seeds 20] > validation.md
"""

from __future__ import annotations

import recorder

if __name__ == "__main__":
    recorder.main(
        "validation", {"best_shift": "validate", "columns": "validate", "held_out_pairs": "validate"}
    )
