"""How far correct solutions stay inside each tolerance of ``integrators``, and how far wrong ones overshoot.

    python tests/benchmarks/calibration/integrators.py [--seeds 200] [--mutant-seeds 20] > integrators.md

Beside the shares of tolerances it records the raw slopes behind the order checks, and the errors they come
from.
"""

from __future__ import annotations

import numpy as np
import recorder

from course.physics.invariants import convergence_order
from course.scoring import kit
from course.scoring.kit import march_all_errors


class SlopeRecorder(recorder.Recorder):
    """Also notes the orders that marches show."""

    def __init__(self) -> None:
        super().__init__()
        self._order = kit.expect_order
        kit.expect_order, kit.march_errors, kit.march_all_errors = self.order, self.march, self.march_all

    def order(self, hs, errors, order, **rest):
        if np.all(np.isfinite(errors)) and np.all(errors > 0):
            self.note(abs(convergence_order(hs, errors) - order) / rest["abs"])
        self._order(hs, errors, order, **rest)

    def march(self, submission, step, problem, counts):
        return self.march_all(submission, step, [problem], counts)[0]

    def march_all(self, submission, step, problems, counts):
        measured = march_all_errors(submission, step, problems, counts)
        for problem, (hs, errors) in zip(problems, measured, strict=True):
            if np.all(np.isfinite(errors)) and np.all(errors > 0):
                self.bounded[f"order of {step} on {problem.name}"].append(convergence_order(hs, errors))
                self.bounded[f"error of {step}"].extend(errors.tolist())
        return measured


if __name__ == "__main__":
    recorder.main("integrators", recorder=SlopeRecorder())
