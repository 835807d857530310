"""A displacement of the plane: a turn about the origin, then a shift."""

from dataclasses import dataclass

import numpy as np

from timemap_cli.maps.grid import Floats
from timemap_cli.model.elementary import cos_sin


@dataclass(frozen=True, slots=True)
class Offset:
    """Takes a point p to R(yaw) p + (dx, dy)."""

    dx: float = 0.0  # [m]
    dy: float = 0.0  # [m]
    yaw: float = 0.0  # [rad], counter-clockwise

    def moved(self, points: Floats) -> Floats:
        """The points (..., 2) [m] after the displacement."""
        cosine, sine = cos_sin(np.array(self.yaw))
        x, y = points[..., 0], points[..., 1]
        return np.stack((cosine * x - sine * y + self.dx, sine * x + cosine * y + self.dy), axis=-1)

    def then(self, later: "Offset") -> "Offset":
        """First this one, then the later one."""
        dx, dy = later.moved(np.array([self.dx, self.dy])).tolist()
        return Offset(dx, dy, self.yaw + later.yaw)

    def about(self, x: float, y: float) -> "Offset":
        """The same with the turn about (x, y) [m] instead of about the origin."""
        turned_x, turned_y = Offset(yaw=self.yaw).moved(np.array([x, y])).tolist()
        return Offset(self.dx + x - turned_x, self.dy + y - turned_y, self.yaw)

    def rounded(self) -> "Offset":
        """To a tenth of a millimetre and a hundred-thousandth of a radian."""
        return Offset(round(self.dx, 4), round(self.dy, 4), round(self.yaw, 5))
