"""Reduces millions of points to what can be seen in a picture."""

import numpy as np

COLUMNS = 450  # about the pixels across a picture


class Envelope:
    """Minimum and maximum in each column of x; if there are few points, the points themselves."""

    def __init__(self, low, high, points, curves=1):
        self._low = low
        self._width = (high - low) / COLUMNS or 1.0
        self.is_exact = points <= 2 * COLUMNS
        self._points = []
        self._min = np.full((COLUMNS, curves), np.inf)
        self._max = np.full((COLUMNS, curves), -np.inf)

    def add(self, x, y):
        """Adds points; y has a column for each curve."""
        if not len(x):
            return
        y = y.reshape(len(x), -1)
        if self.is_exact:
            self._points.append((x, y))
        else:
            column = np.clip(((x - self._low) / self._width).astype('i2'), 0, COLUMNS - 1)
            if (np.diff(column) < 0).any():
                order = np.argsort(column, kind='stable')
                column, y = column[order], y[order]
            starts = np.flatnonzero(np.diff(column, prepend=-1))
            for values, reduce in ((self._min, np.minimum), (self._max, np.maximum)):
                values[column[starts]] = reduce(values[column[starts]], reduce.reduceat(y, starts))

    def line(self, gap, columns=1.5):
        """x and y of a line through all points, broken where x has a gap larger than `gap` and than this number of columns. In
        each column it goes from minimum to maximum."""
        x, y = self.points()
        breaks = np.flatnonzero(np.diff(x) > max(gap, 0 if self.is_exact else columns * self._width)) + 1
        return np.insert(x, breaks, np.nan), np.insert(y, breaks, np.nan, axis=0)

    def points(self):
        """x and y of all points, or of the minimum and maximum in each column."""
        if self.is_exact:
            if not self._points:
                return np.zeros(0), np.zeros((0, self._min.shape[1]))
            return np.concatenate([x for x, _ in self._points]), np.concatenate([y for _, y in self._points])
        full = np.flatnonzero(np.isfinite(self._min[:, 0]))
        x = self._low + (np.repeat(full, 2) + 0.5) * self._width
        return x, np.stack([self._min[full], self._max[full]], axis=1).reshape(len(x), self._min.shape[1])
