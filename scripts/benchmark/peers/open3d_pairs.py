"""Open3D's fast global registration and RANSAC on FPFH features, all pairs, synchronised."""
import argparse

import pairwise

VOXEL = 0.05    # radii; features and distances below follow Open3D's own tutorial
SEED = 1


def main():
    p = argparse.ArgumentParser()
    p.add_argument("table"), p.add_argument("poses"), p.add_argument("--method", choices=("fgr", "ransac"))
    a = p.parse_args()
    try:
        import open3d as o3d
    except (ImportError, OSError) as error:
        pairwise.missing(error)
    reg = o3d.pipelines.registration
    o3d.utility.random.seed(SEED)
    views = pairwise.read_views(a.table)

    def prepared(points):
        cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
        cloud.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(radius=2 * VOXEL, max_nn=30))
        cloud.orient_normals_towards_camera_location([0, 0, 0])
        return cloud, reg.compute_fpfh_feature(cloud, o3d.geometry.KDTreeSearchParamHybrid(radius=5 * VOXEL, max_nn=100))

    ready = {id(v[1]): prepared(v[1]) for v in views}

    def register(moving, fixed):
        (m, fm), (f, ff) = ready[id(moving)], ready[id(fixed)]
        if a.method == "fgr":
            result = reg.registration_fgr_based_on_feature_matching(
                m, f, fm, ff, reg.FastGlobalRegistrationOption(maximum_correspondence_distance=VOXEL))
        else:
            result = reg.registration_ransac_based_on_feature_matching(
                m, f, fm, ff, True, 1.5 * VOXEL, reg.TransformationEstimationPointToPoint(False), 3,
                [reg.CorrespondenceCheckerBasedOnEdgeLength(0.9),
                 reg.CorrespondenceCheckerBasedOnDistance(1.5 * VOXEL)], reg.RANSACConvergenceCriteria(50000, 0.999))
        return pairwise.nearest_rotation(result.transformation[:3, :3]), result.fitness + 1e-3

    pairwise.write_poses(a.poses, views, pairwise.register_all(views, register))
    print(f"open3d {o3d.__version__}")


if __name__ == "__main__":
    main()
