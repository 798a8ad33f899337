"""Wrong: limits that are met exactly do not count."""

_OPERATORS = {"<=": operator.lt, ">=": operator.gt, "==": operator.eq}
