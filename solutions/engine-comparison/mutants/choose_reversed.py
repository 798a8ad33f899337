"""Wrong: the operators the wrong way round."""

_OPERATORS = {"<=": operator.ge, ">=": operator.le, "==": operator.eq}
