"""A scene's formulas are refused in a scene's words."""

import pytest

from course.errors import UsageError
from course.sandbox.scene.expression import evaluate, names


def test_a_formula_is_a_float_whatever_its_numbers():
    assert type(evaluate("2 * g", {"g": 3})) is float
    assert names("max(a, b.x) + pi") == {"a", "b.x"}


@pytest.mark.parametrize("text", ["", "'a' * 9", "1+" * 400 + "1", "unknown + 1", "1 / 0", "sqrt(1, 2)"])
def test_whatever_is_not_arithmetic_is_refused_in_words(text):
    with pytest.raises(UsageError) as caught:
        evaluate(text, {"a": 1.0, "x": 1.0})
    assert "formula" in caught.value.message
    assert len(caught.value.message) < 200
