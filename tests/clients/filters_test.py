"""Every filter that is deterministic against filterpy, to 1e-9, on random walks with gaps, uneven steps and uneven noise.

    filters_test.py PROGRAM      PROGRAM is filter_states; exits 77 (skipped) where filterpy is not installed

filterpy supplies the filters; the motion models are written here again, by matrix exponentials instead of closed forms.
"""
import subprocess
import sys

try:
    import numpy as np
    from filterpy.gh import GHFilter
    from filterpy.kalman import ExtendedKalmanFilter, IMMEstimator, JulierSigmaPoints, KalmanFilter, UnscentedKalmanFilter
    from scipy.linalg import expm
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)

TOLERANCE = 1e-9


def kron(F, D):
    return np.kron(np.asarray(F, dtype=float), np.eye(D))


def noise_integral(A, G, dt):
    """∫ e^(A s) G e^(A s)ᵀ ds over dt, by Van Loan's block exponential, in units in which dt is 1 (so that no digits are lost)."""
    n = len(A)
    unit = np.diag([dt ** -k for k in range(n)])  # state = unit @ state in steps
    inverse = np.linalg.inv(unit)
    A1 = inverse @ A @ unit * dt
    G1 = inverse @ G @ inverse * dt
    big = expm(np.block([[-A1, G1], [np.zeros((n, n)), A1.T]]))
    F1 = big[n:, n:].T
    return unit @ F1 @ big[:n, n:] @ unit


def white(order, density, dt):
    """F and Q of a motion whose derivative of this order is white noise."""
    A = np.eye(order, k=1)
    G = np.zeros((order, order))
    G[-1, -1] = density
    return expm(A * dt), noise_integral(A, G, dt)


class Reference:
    """A filterpy filter with a state of `order` blocks, position first."""

    def __init__(self, p, z, R):
        self.p = p
        self.D = len(z)

    def out(self):
        D = self.D
        return np.concatenate([self.f.x[:D], self.f.P[:D, :D].ravel()]), self.f.x[D:2 * D]


class Linear(Reference):
    order, initial = 2, ("initial_speed",)

    def __init__(self, p, z, R):
        super().__init__(p, z, R)
        D = self.D
        self.f = KalmanFilter(dim_x=D * self.order, dim_z=D)
        self.f.x = np.concatenate([z, np.zeros(D * (self.order - 1))])
        self.f.P = kron(np.diag([0.0] + [p[name] ** 2 for name in self.initial]), D)
        self.f.P[:D, :D] = R
        self.f.H = np.eye(D, D * self.order)

    def predict(self, dt):
        F, Q = self.model(dt)
        self.f.predict(F=kron(F, self.D), Q=kron(Q, self.D))

    def correct(self, z, R):
        self.f.update(z, R=R)


class Kalman(Linear):
    def model(self, dt):
        return white(2, self.p["acceleration_noise"] ** 2, dt)


class KalmanAcceleration(Linear):
    order, initial = 3, ("initial_speed", "initial_acceleration")

    def model(self, dt):
        return white(3, self.p["jerk_noise"] ** 2, dt)


class KalmanPaper(Linear):
    def __init__(self, p, z, R):
        super().__init__({**p, "initial_speed": np.sqrt(p["initial_velocity_variance"])}, z, R)
        D = self.D
        self.f.P[:D, :D] = 0
        self.R = np.eye(D) * (p["r_xx"] + p["r_yy"]) / 2
        self.R[:2, :2] = [[p["r_xx"], p["r_xy"]], [p["r_xy"], p["r_yy"]]]

    def predict(self, dt):
        D, frames = self.D, dt * self.p["frame_rate"]
        q = frames * (self.p["noise_per_speed"] * np.abs(self.f.x[D:]) + self.p["least_noise"])
        self.f.predict(F=kron([[1, frames], [0, 1]], D), Q=np.diag(np.concatenate([np.zeros(D), q])))

    def correct(self, z, R):
        self.f.update(z, R=self.R)

    def out(self):
        state, velocity = super().out()
        return state, velocity * self.p["frame_rate"]


class AlphaBeta(Reference):
    def __init__(self, p, z, R):
        super().__init__(p, z, R)
        self.f = GHFilter(x=z, dx=np.zeros(len(z)), dt=1.0, g=p["alpha"], h=p["beta"])
        self.waited = 0.0

    def predict(self, dt):
        self.waited += dt

    def correct(self, z, R):
        self.f.dt = self.waited
        self.f.update(z)
        self.waited = 0.0

    def out(self):
        return self.f.x + self.waited * self.f.dx, self.f.dx


class Extrapolation(Reference):
    """numpy's polynomial through the last three positions."""

    def __init__(self, p, z, R):
        super().__init__(p, z, R)
        assert p["bend"] == 1
        self.now = 0.0
        self.seen = [(0.0, z)]

    def predict(self, dt):
        self.now += dt

    def correct(self, z, R):
        self.seen = (self.seen + [(self.now, z)])[-3:]

    def out(self):
        times = np.array([t for t, _ in self.seen]) - self.now
        places = np.array([z for _, z in self.seen])
        degree = len(times) - 1
        coefficients = np.linalg.solve(np.vander(times, degree + 1, increasing=True), places)
        return coefficients[0], coefficients[1] if degree else np.zeros(self.D)


def turn(x, dt, turn_time, D):
    """The coordinated turn by the exponential of the velocity's rotation; complex numbers may come, for derivatives."""
    w = x[2 * D:]
    if D == 2:
        spin = np.array([[0, -w[0]], [w[0], 0]])
    else:
        spin = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    A = np.zeros((2 * D, 2 * D), dtype=x.dtype)
    A[:D, D:] = np.eye(D)
    A[D:, D:] = spin
    return np.concatenate([expm(A * dt) @ x[:2 * D], w * np.exp(-dt / turn_time)])


class Ptz(Reference):
    def start(self, z, R):
        D, p = self.D, self.p
        self.turns = 1 if D == 2 else 3
        self.n = 2 * D + self.turns
        x = np.concatenate([z, np.zeros(self.n - D)])
        P = np.diag([0.0] * D + [p["initial_speed"] ** 2] * D + [p["turn_sigma"] ** 2] * self.turns)
        P[:D, :D] = R
        return x, P

    def noise(self, dt):
        D, p = self.D, self.p
        Q = np.zeros((self.n, self.n))
        Q[:2 * D, :2 * D] = kron(white(2, p["acceleration_noise"] ** 2, dt)[1], D)
        Q[2 * D:, 2 * D:] = np.eye(self.turns) * p["turn_sigma"] ** 2 * (1 - np.exp(-2 * dt / p["turn_time"]))
        return Q


class Extended(Ptz):
    def __init__(self, p, z, R):
        super().__init__(p, z, R)
        x, P = self.start(z, R)
        self.f = ExtendedKalmanFilter(dim_x=self.n, dim_z=self.D)
        self.f.x, self.f.P = x, P

    def predict(self, dt):
        move = lambda x: turn(x, dt, self.p["turn_time"], self.D)  # noqa: E731
        F = np.empty((self.n, self.n))
        for k in range(self.n):  # a complex step: exact to rounding
            x = self.f.x.astype(complex)
            x[k] += 1e-40j
            F[:, k] = move(x).imag / 1e-40
        self.f.F, self.f.Q = F, self.noise(dt)
        x = move(self.f.x)
        self.f.predict()
        self.f.x = x

    def correct(self, z, R):
        H = np.eye(self.D, self.n)
        self.f.update(z, lambda x: H, lambda x: H @ x, R=R)


class Unscented(Ptz):
    def __init__(self, p, z, R):
        super().__init__(p, z, R)
        x, P = self.start(z, R)
        D = self.D
        points = JulierSigmaPoints(self.n, kappa=p["kappa"])
        self.f = UnscentedKalmanFilter(self.n, D, 1.0, hx=lambda s: s[:D],
                                       fx=lambda s, dt: turn(s, dt, p["turn_time"], D), points=points)
        self.f.x, self.f.P = x, P

    def predict(self, dt):
        self.f.Q = self.noise(dt)
        self.f.predict(dt=dt)
        # What was added to P is to be seen by the measurement: draw the points again.
        self.f.sigmas_f = self.f.points_fn.sigma_points(self.f.x, self.f.P)

    def correct(self, z, R):
        self.f.update(z, R=R)


class Interacting(Reference):
    def __init__(self, p, z, R):
        super().__init__(p, z, R)
        D = self.D
        self.shares = np.array([p["share_0"], p["share_1"], p["share_2"], 0])
        filters = []
        for model in (self.constant_velocity, self.pull, self.turn, self.swerve):
            f = KalmanFilter(dim_x=3 * D, dim_z=D)
            f.x = np.concatenate([z, np.zeros(2 * D)])
            f.P = kron(np.diag([0.0, p["initial_speed"] ** 2, p["acceleration"] ** 2]), D)
            f.P[:D, :D] = R
            f.H = np.eye(D, 3 * D)
            plain = f.predict

            def predict(u=None, f=f, plain=plain, model=model):
                F, Q = model(f)
                plain(F=kron(F, D), Q=kron(Q, D))

            f.predict = predict
            filters.append(f)
        self.f = IMMEstimator(filters, self.shares.copy(), np.full((4, 4), 0.25))

    def constant_velocity(self, f):
        F, Q = np.zeros((3, 3)), np.zeros((3, 3))
        F[:2, :2], Q[:2, :2] = white(2, self.p["steady_noise"] ** 2, self.dt)
        Q[2, 2] = self.sigma ** 2
        return F, Q

    def pull(self, f):
        time = self.p["acceleration_time"]
        A = np.eye(3, k=1)
        A[2, 2] = -1 / time
        return expm(A * self.dt), noise_integral(A, np.diag([0, 0, 2 * self.sigma ** 2 / time]), self.dt)

    def turn(self, f):
        D = self.D
        v, a = f.x[D:2 * D], f.x[2 * D:]
        across = np.sqrt(max(0.0, v @ v * (a @ a) - (v @ a) ** 2))
        size = v @ v + np.trace(f.P[D:2 * D, D:2 * D])
        rate = min(self.p["turn_limit"], across / size) if size > 0 else 0.0
        A = np.array([[0, 1, 0], [0, 0, 1], [0, -rate ** 2, 0]])
        return expm(A * self.dt), white(3, 2 * self.sigma ** 2 / self.p["acceleration_time"], self.dt)[1]

    def swerve(self, f):
        F, Q = np.zeros((3, 3)), np.zeros((3, 3))
        F[:2, :2] = [[1, self.dt], [0, 1]]
        Q[:2, :2] = self.jump ** 2 * np.array([[self.dt ** 2 / 3, self.dt / 2], [self.dt / 2, 1]])
        Q[2, 2] = self.sigma ** 2
        return F, Q

    def predict(self, dt):
        D = self.D
        self.dt = dt
        speed = np.linalg.norm(self.f.x[D:2 * D])
        self.sigma = self.p["acceleration"] + self.p["agility"] * speed
        self.jump = self.p["swerve_speed"] + self.p["swerve_share"] * speed
        keep = np.diag([np.exp(-dt / self.p["mode_time"])] * 3 + [0])
        swerves = 1 - np.exp(-dt * self.p["swerve_rate"])
        M = keep + (np.eye(4) - keep) @ np.tile(self.shares, (4, 1))
        self.f.M = (1 - swerves) * M + swerves * np.array([0, 0, 0, 1])
        self.f._compute_mixing_probabilities()
        self.f.predict()
        self.f.mu = self.f.cbar.copy()
        self.f._compute_state_estimate()

    def correct(self, z, R):
        for f in self.f.filters:
            f.R = R
        self.f.cbar = self.f.mu.copy()
        self.f.M = np.eye(4)  # the change of model is in mu already; update() forms cbar of the next step with M
        self.f.update(z)


FILTERS = {
    "alpha-beta": AlphaBeta, "alpha-beta-variable": AlphaBeta, "extrapolation": Extrapolation, "kalman": Kalman,
    "kalman-paper": KalmanPaper, "kalman-acceleration": KalmanAcceleration, "ekf": Extended, "ukf": Unscented, "imm": Interacting,
}


def largest_difference(program, name, D, seed):
    lines = subprocess.run([program, name, str(D), str(seed)], check=True, capture_output=True, text=True).stdout.splitlines()
    p = {key: float(value) for key, value in (pair.split("=") for pair in lines[0].split())}
    rows = np.array([[float(entry) for entry in line.split()] for line in lines[1:]])
    sizes = [1, 1, D, D * D, D, D * D, D, D, D * D]
    worst = 0.0
    reference = None

    def compare(mine, theirs):
        return np.max(np.abs(np.asarray(mine) - theirs) / (1 + np.abs(theirs))) if len(theirs) else 0.0

    for row in rows:
        dt, seen, z, R, place, cov, x, v, P = np.split(row, np.cumsum(sizes)[:-1])
        R = R.reshape(D, D)
        if reference is None:
            reference = FILTERS[name](p, z.copy(), R)
            continue
        reference.predict(dt[0])
        state, _ = reference.out()
        worst = max(worst, compare(np.concatenate([place, cov])[:len(state)], state))
        if seen[0]:
            reference.correct(z.copy(), R)
        state, velocity = reference.out()
        worst = max(worst, compare(np.concatenate([x, P])[:len(state)], state), compare(v, velocity))
    return worst, len(rows)


def main():
    program = sys.argv[1]
    bad = 0
    for name in FILTERS:
        for D in (2, 3):
            worst = max(largest_difference(program, name, D, seed)[0] for seed in (1, 2, 3))
            verdict = "ok" if worst <= TOLERANCE else "DIFFERS"
            bad += worst > TOLERANCE
            print(f"{name:20} {D}D  largest difference {worst:.1e}  {verdict}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
