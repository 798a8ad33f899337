"""Claims while it is loaded that the lockdown failed, to look like the grader's fault."""

from frames import *


sock.sendall(wire.Codec().encode(wire.Kind.REFUSED, {"stage": "lockdown", "message": "no Landlock"}))
