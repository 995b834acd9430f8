// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/CameraPath.h>
#include <pointplane/simulation/RowCaster.h>
#include <pointplane/simulation/scenes.h>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
PinholeCamera smallCamera()
{
    PinholeCamera camera;
    return camera.scaled(0.25);
}
}  // namespace

TEST(RowCaster, agreesWithEverySurfaceTestedByItself)
{
    // The desk has rectangles, discs and cylinders, in front of and behind each other.
    const Scene scene = makeScene("desk", 1);
    const PinholeCamera camera = smallCamera();
    const CameraPath path(scene.motion, 1, 5);
    RowCaster caster(scene, camera);
    std::vector<float> q(static_cast<std::size_t>(camera.width));
    std::vector<std::int32_t> id(q.size());
    int differing = 0;
    for (int v = 0; v < camera.height; v += 2)
    {
        const Eigen::Isometry3d T_world_cam = path.pose(0.1 * v);
        caster.setRow(T_world_cam, v);
        caster.cast(q.data(), id.data());
        for (int u = 0; u < camera.width; ++u)
        {
            const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
            double nearest = 0;
            for (const Surface& surface : scene.surfaces)
            {
                nearest = std::max(
                    nearest,
                    surface.inverseDepth(T_world_cam.translation(), T_world_cam.linear() * ray));
            }
            // A ray through the very edge of a surface may go either way.
            const auto k = static_cast<std::size_t>(u);
            differing += std::abs(static_cast<double>(q[k]) - nearest) > 1e-6 ? 1 : 0;
        }
    }
    EXPECT_LE(differing, 2);
}

TEST(RowCaster, samplesBetweenColumnsAgreeWithTheRow)
{
    const Scene scene = makeScene("desk", 1);
    const PinholeCamera camera = smallCamera();
    RowCaster caster(scene, camera);
    caster.setRow(CameraPath(scene.motion, 0, 1).pose(0), 60);
    std::vector<float> q(static_cast<std::size_t>(camera.width));
    std::vector<std::int32_t> id(q.size());
    std::vector<cv::Vec3b> bgr(q.size());
    caster.cast(q.data(), id.data());
    caster.shade(q.data(), id.data(), bgr.data());
    for (int u = 0; u < camera.width; ++u)
    {
        const auto k = static_cast<std::size_t>(u);
        ASSERT_GE(id[k], 0);
        const double here = caster.inverseDepthAt(u, id[k]);
        EXPECT_NEAR(here, static_cast<double>(q[k]), 1e-6);
        EXPECT_LE(cv::norm(caster.colourAt(u, id[k], here) - bgr[k], cv::NORM_INF), 2);
    }
}
}  // namespace pointplane
