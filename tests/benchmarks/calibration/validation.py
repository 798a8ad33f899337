"""How far correct solutions stay inside each tolerance of ``validation``, and how far wrong ones overshoot.

python tests/benchmarks/calibration/validation.py [--seeds 200] [--mutant-seeds 20] > validation.md
"""

from __future__ import annotations

import recorder

if __name__ == "__main__":
    recorder.main(
        "validation",
        dict.fromkeys(
            ("best_shift", "columns", "held_out_pairs", "measures", "interval_of_each"), "validate"
        ),
    )
