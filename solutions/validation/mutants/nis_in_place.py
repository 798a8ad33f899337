"""The whitened innovations may replace the innovations."""


def nis(nu, S):
    for i in range(len(nu)):
        nu[i] = np.linalg.solve(np.linalg.cholesky(S[i]), nu[i])
    return np.sum(nu**2, axis=1)
