"""Sends right-hand sides named by right-hand sides while it is loaded."""

from frames import *


raw(wire.Kind.LOADED, b"p" * 100_000 + b"N")
