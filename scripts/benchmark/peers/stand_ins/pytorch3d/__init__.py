"""What the authors' POLAR imports of PyTorch3D, which needs a build of its own: rotations, transforms of points and the
Chamfer distance, written here from their definitions. Only the arguments that POLAR uses."""
