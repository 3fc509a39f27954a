"""Chamfer distance: squared distance of every point to the nearest of the other cloud, averaged, both ways added."""
import torch

MOST_PAIRS = 1 << 25  # distances held at once


def nearest_squared(x, y):
    """(N, P): for every point of x (N, P, 3) its squared distance to the nearest of y (N, Q, 3). The neighbour is found
    through |x|^2 - 2 x y + |y|^2, its distance then taken exactly, so that it has a gradient and no cancellation."""
    chunk, out = max(1, MOST_PAIRS // (x.shape[1] * y.shape[1])), []
    for a, b in zip(x.split(chunk), y.split(chunk)):
        with torch.no_grad():
            squares = b.square().sum(2)[:, None]
            index = torch.baddbmm(squares, a, b.transpose(1, 2), alpha=-2).argmin(2)
        out.append((a - b.gather(1, index[..., None].expand(-1, -1, 3))).square().sum(2))
    return torch.cat(out)


def chamfer_distance(x, y, batch_reduction="mean", point_reduction="mean", single_directional=False):
    """(distance, None): the second would be of normals."""
    parts = [nearest_squared(x, y)] + ([] if single_directional else [nearest_squared(y, x)])
    if point_reduction == "mean":
        parts = [p.mean(1) for p in parts]
    elif point_reduction is not None or len(parts) > 1:
        raise ValueError("points are averaged, or kept apart in one direction")
    total = sum(parts)
    return (total.mean(0) if batch_reduction == "mean" else total), None
