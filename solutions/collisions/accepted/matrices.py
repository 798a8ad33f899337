"""Impacts as linear maps: I - (1+e) n n^T on the relative velocity, and a projector for the slip."""


def resolve(ma, mb, va, vb, normal, restitution):
    return resolve_with_friction(ma, mb, va, vb, normal, restitution, 0.0)


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    n = np.reshape(normal, (-1, 1)).astype(float)
    u = np.reshape(np.subtract(va, vb), (-1, 1)).astype(float)
    if (n.T @ u).item() <= 0:
        return np.copy(va), np.copy(vb)
    m = 1 / (1 / ma + 1 / mb)
    along = n @ n.T
    press = -m * (1 + restitution) * along @ u
    stick = -m * (np.eye(len(n)) - along) @ u
    limit, size = mu * np.linalg.norm(press), np.linalg.norm(stick)
    p = press + stick * (limit / size if size > limit else 1.0)
    return (va + p[:, 0] / ma), (vb - p[:, 0] / mb)
