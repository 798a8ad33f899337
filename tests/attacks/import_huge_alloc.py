"""Allocates until nothing is left while it is loaded."""

hoard = []
for _ in range(64):
    hoard.append(np.empty(32 << 20))
