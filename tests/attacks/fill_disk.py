"""Writes until the folder is full."""

written = 0
try:
    for k in range(40):
        with open(f"course_attack_{k}", "wb") as handle:
            written += handle.write(b"x" * (1 << 20))
    with open("course_attack_big", "wb") as handle:
        handle.seek(1 << 40)
        handle.write(b"x")
except OSError as error:
    print(written, error)
