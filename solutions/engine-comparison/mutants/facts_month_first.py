"""Wrong: a date in another form."""

_AS_OF = "11/21/2026"
