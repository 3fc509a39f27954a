"""What stands in for PyTorch3D beside the authors' POLAR, against definitions. Skipped where torch is not installed."""
import sys
import unittest
from pathlib import Path

NOT_INSTALLED = 77
try:
    import torch
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(NOT_INSTALLED)

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts/benchmark/peers/stand_ins"))
from pytorch3d import transforms  # noqa: E402
from pytorch3d.loss import chamfer_distance  # noqa: E402

DOUBLE = {"dtype": torch.float64}
ROUNDING = 1e-12
SINGLE_ROUNDING = 1e-5


class Rotations(unittest.TestCase):
    def setUp(self):
        torch.manual_seed(1)
        self.rotation = transforms.quaternion_to_matrix(torch.randn(200, 4, **DOUBLE))

    def test_quaternions_become_rotations(self):
        eye = torch.eye(3, **DOUBLE)
        self.assertLess((self.rotation @ self.rotation.mT - eye).abs().max(), ROUNDING)
        self.assertLess((torch.linalg.det(self.rotation) - 1).abs().max(), ROUNDING)
        quarter = transforms.quaternion_to_matrix(torch.tensor([1.0, 0, 0, 1], **DOUBLE))  # about z
        self.assertLess((quarter @ torch.tensor([1.0, 0, 0], **DOUBLE) - torch.tensor([0, 1.0, 0], **DOUBLE)).abs().max(),
                        ROUNDING)

    def test_euler_angles_read_back(self):
        angles = transforms.matrix_to_euler_angles(self.rotation, "ZXZ")
        self.assertLess((transforms.euler_angles_to_matrix(angles, "ZXZ") - self.rotation).abs().max(), 1e-6)

    def test_transforms_apply_from_left_to_right_and_invert(self):
        points, shift = torch.randn(7, 3, **DOUBLE), torch.randn(2, 3, **DOUBLE)
        scale = torch.tensor([2.0, 3.0], **DOUBLE)
        both = transforms.Transform3d(**DOUBLE).scale(scale).rotate(self.rotation[:2]).translate(shift)
        moved = both.transform_points(points)
        self.assertEqual(moved.shape, (2, 7, 3))
        self.assertLess((moved[1] - (3 * points @ self.rotation[1] + shift[1])).abs().max(), ROUNDING)
        self.assertLess((both.inverse()[1].transform_points(moved[1]) - points).abs().max(), ROUNDING)


class Chamfer(unittest.TestCase):
    def test_equals_its_definition(self):
        torch.manual_seed(1)
        x, y = torch.rand(3, 50, 3), torch.rand(3, 60, 3)
        squared = (x[:, :, None] - y[:, None]).square().sum(3)
        there, back = squared.min(2).values, squared.min(1).values
        both = chamfer_distance(x, y, batch_reduction=None)[0]
        self.assertLess((both - there.mean(1) - back.mean(1)).abs().max(), SINGLE_ROUNDING)
        single = chamfer_distance(x, y, batch_reduction=None, single_directional=True, point_reduction=None)[0]
        self.assertLess((single - there).abs().max(), SINGLE_ROUNDING)


if __name__ == "__main__":
    unittest.main()
