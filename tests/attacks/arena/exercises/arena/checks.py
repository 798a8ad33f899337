"""Public checks of the arena."""

import numpy as np
import pytest
from course.scoring import kit


@pytest.mark.task("scale")
@pytest.mark.points(2)
def test_scale_small(submission):
    """Every number is multiplied"""
    values = [1.0, -2.0, 4.0]
    kit.expect_array(
        submission.call("scale", np.array(values), 3.0),
        [3.0, -6.0, 12.0],
        source="exact",
        quantity="product",
        input={"values": values, "factor": 3.0},
        message="The numbers are not multiplied.",
        help="Multiply each.",
    )


@pytest.mark.task("scale")
@pytest.mark.points(1)
def test_scale_length(submission):
    """As many numbers come back as were given"""
    kit.expect_length(
        submission.call("scale", np.ones(5), 1.0), 5, message="The number of values is wrong.", help="Keep all."
    )
