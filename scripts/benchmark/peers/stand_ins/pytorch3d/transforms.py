"""Rotations and affine transforms of points. Points are rows: y = x M, transforms apply from left to right."""
import torch

AXES = {"X": (1, 2), "Y": (2, 0), "Z": (0, 1)}  # the plane that a turn about each axis turns


def about(axis, angle):
    """Rotation matrices (..., 3, 3) that turn column vectors by angle (...) about a coordinate axis."""
    i, j = AXES[axis]
    flat = [torch.zeros_like(angle)] * 9
    for k in range(3):
        flat[4 * k] = torch.ones_like(angle)
    flat[4 * i] = flat[4 * j] = torch.cos(angle)
    flat[3 * i + j], flat[3 * j + i] = -torch.sin(angle), torch.sin(angle)
    return torch.stack(flat, dim=-1).reshape(*angle.shape, 3, 3)


def euler_angles_to_matrix(angles, convention):
    """R = R_first(a) R_second(b) R_third(c)."""
    first, second, third = (about(axis, angles[..., k]) for k, axis in enumerate(convention))
    return first @ second @ third


def matrix_to_euler_angles(matrix, convention):
    """The inverse for ZXZ: R_22 = cos b, R_02 = sin a sin b, R_12 = -cos a sin b, R_20 = sin b sin c, R_21 = sin b cos c."""
    if convention != "ZXZ":
        raise ValueError(f"only ZXZ is written here, not {convention}")
    second = torch.acos(matrix[..., 2, 2].clamp(-1, 1))
    return torch.stack([torch.atan2(matrix[..., 0, 2], -matrix[..., 1, 2]), second,
                        torch.atan2(matrix[..., 2, 0], matrix[..., 2, 1])], dim=-1)


def quaternion_to_matrix(q):
    """Real part first; R = I + 2 w [v] + 2 [v]^2 with the cross product matrix [v] of the unit quaternion's vector."""
    w, x, y, z = torch.nn.functional.normalize(q, dim=-1).unbind(-1)
    zero = torch.zeros_like(w)
    cross = torch.stack([zero, -z, y, z, zero, -x, -y, x, zero], dim=-1).reshape(*w.shape, 3, 3)
    return torch.eye(3, dtype=q.dtype, device=q.device) + 2 * w[..., None, None] * cross + 2 * cross @ cross


class Transform3d:
    """A batch of affine transforms; `matrix` is (N, 4, 4), its last row the translation."""

    def __init__(self, dtype=torch.float32, device="cpu", matrix=None):
        self.matrix = torch.eye(4, dtype=dtype, device=device)[None] if matrix is None else matrix

    def __len__(self):
        return len(self.matrix)

    def __getitem__(self, index):
        chosen = self.matrix[index]
        return Transform3d(matrix=chosen[None] if chosen.ndim == 2 else chosen)

    def get_matrix(self):
        return self.matrix

    def then(self, linear, translation):
        """Followed by x linear + translation, both of a batch."""
        n = max(len(linear), len(translation))
        top = torch.cat([linear, linear.new_zeros(len(linear), 3, 1)], dim=2).expand(n, 3, 4)
        bottom = torch.cat([translation, translation.new_ones(len(translation), 1)], dim=1)[:, None].expand(n, 1, 4)
        return Transform3d(matrix=self.matrix @ torch.cat([top, bottom], dim=1))

    def scale(self, factor):
        factor = factor.reshape(-1, 1, 1)
        return self.then(factor * torch.eye(3, dtype=factor.dtype, device=factor.device), factor.new_zeros(1, 3))

    def rotate(self, rotation):
        rotation = rotation.reshape(-1, 3, 3)
        return self.then(rotation, rotation.new_zeros(1, 3))

    def translate(self, shift):
        return self.then(torch.eye(3, dtype=shift.dtype, device=shift.device)[None], shift.reshape(-1, 3))

    def inverse(self):
        return Transform3d(matrix=torch.linalg.inv(self.matrix))

    def transform_points(self, points):
        """(P, 3) or (N, P, 3) -> (N, P, 3); (P, 3) where both are single."""
        moved = points @ self.matrix[:, :3, :3] + self.matrix[:, 3:, :3]
        return moved[0] if len(moved) == 1 and points.ndim == 2 else moved


class Rotate(Transform3d):
    def __init__(self, R, dtype=torch.float32):  # the name of the argument is theirs
        super().__init__(matrix=Transform3d(dtype, R.device).rotate(R.to(dtype)).matrix)
