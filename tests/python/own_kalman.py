"""A filter of one's own, for the tests of jobs."""

from simulated_video import np


class Kalman:
    """A filter of one's own: what `filter="kalman"` is, in NumPy."""

    acceleration_noise, initial_speed = 200.0, 300.0  # px

    def __init__(self, z, R, unit):
        size = len(z)
        self.units = unit
        self.H = np.hstack([np.eye(size), np.zeros((size, size))])
        self.x = np.concatenate([z, np.zeros(size)])
        self.P = np.zeros((2 * size, 2 * size))
        self.P[:size, :size] = R
        self.P[size:, size:] = (self.initial_speed * unit) ** 2 * np.eye(size)

    def predict(self, dt):
        one = np.eye(len(self.H))
        F = np.block([[one, dt * one], [0 * one, one]])
        q = (self.acceleration_noise * self.units) ** 2 * dt
        self.x = F @ self.x
        self.P = F @ self.P @ F.T + q * np.block([[dt * dt / 3 * one, dt / 2 * one], [dt / 2 * one, one]])

    def correct(self, z, R):
        K = self.P @ self.H.T @ np.linalg.inv(self.H @ self.P @ self.H.T + R)
        self.x = self.x + K @ (z - self.H @ self.x)
        self.P = (np.eye(len(self.x)) - K @ self.H) @ self.P

    @property
    def position(self):
        return self.x[: len(self.H)]

    @property
    def velocity(self):
        return self.x[len(self.H) :]

    @property
    def covariance(self):
        return self.P[: len(self.H), : len(self.H)]
