// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/simulation/Scene.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** Spacing of the points at which light is evaluated; in between it is interpolated. */
constexpr double kLightGrid = 0.04;

bool isLit(const Scene& scene, const Eigen::Vector3d& lamp, const Eigen::Vector3d& point)
{
    const Eigen::Vector3d ray = point - lamp;
    for (const Surface& surface : scene.surfaces)
    {
        // 1 / z = 1 at the point itself; surfaces touching it do not count. What moves casts no
        // shadow: that would not stay where it is painted.
        if (surface.mover < 0 && surface.inverseDepth(lamp, ray) > 1.005)
        {
            return false;
        }
    }
    return true;
}

double brightness(
    const Scene& scene,
    const Lamp& lamp,
    const Eigen::Vector3d& point,
    const Eigen::Vector3d& normal)
{
    constexpr int kSide = 3;
    double sum = 0;
    for (int i = 0; i < kSide * kSide; ++i)
    {
        const double dx = (i % kSide + 0.5) / kSide - 0.5;
        const double dy = (i / kSide + 0.5) / kSide - 0.5;
        const Eigen::Vector3d from = lamp.position + lamp.size * Eigen::Vector3d(dx, dy, 0);
        const Eigen::Vector3d to = from - point;
        const double distance = to.norm();
        const double cosine = normal.dot(to) / distance;
        if (cosine > 0 && isLit(scene, from, point))
        {
            sum += cosine * std::pow(1.5 / std::max(distance, 0.5), 1.2);
        }
    }
    // A little more from above, so that no two sides of a box look alike in the shadow.
    const double sky = 1 + 0.15 * normal.z() + 0.06 * normal.x();
    return lamp.ambient * sky + lamp.power * sum / (kSide * kSide);
}

cv::Mat lightMap(const Scene& scene, const Lamp& lamp, const Surface& surface)
{
    const Eigen::Vector2d size = surface.pictureSize();
    const int cols = std::max(4, static_cast<int>(std::lround(size.x() / kLightGrid)));
    const int rows = std::max(4, static_cast<int>(std::lround(size.y() / kLightGrid)));
    cv::Mat map(rows, cols, CV_32FC1);
    for (int y = 0; y < rows; ++y)
    {
        for (int x = 0; x < cols; ++x)
        {
            Eigen::Vector3d point, normal;
            surface.pictureToWorld(
                (x + 0.5) / cols * size.x(), (y + 0.5) / rows * size.y(), point, normal);
            map.at<float>(y, x) =
                static_cast<float>(brightness(scene, lamp, point + 1e-3 * normal, normal));
        }
    }
    return map;
}
}  // namespace

Scene withoutMovers(const Scene& scene)
{
    Scene out = scene;
    out.movers.clear();
    const auto moves = [](const Surface& surface) { return surface.mover >= 0; };
    out.surfaces.erase(
        std::remove_if(out.surfaces.begin(), out.surfaces.end(), moves), out.surfaces.end());
    return out;
}

void bakeTextures(
    Scene& scene,
    const Lamp& lamp,
    const std::vector<cv::Mat>& pictures,
    const std::vector<double>& texels)
{
    POINTPLANE_CHECK(
        pictures.size() == scene.surfaces.size() && texels.size() == pictures.size(),
        "need one picture per surface");
    for (std::size_t i = 0; i < pictures.size(); ++i)
    {
        const cv::Mat coarse = lightMap(scene, lamp, scene.surfaces[i]);
        cv::Mat light, light3, lit;
        cv::resize(coarse, light, pictures[i].size(), 0, 0, cv::INTER_LINEAR);
        cv::merge(std::vector<cv::Mat>{light, light, light}, light3);
        cv::multiply(pictures[i], light3, lit, 1, CV_8UC3);
        scene.surfaces[i].texture = Texture(lit, texels[i]);
    }
}
}  // namespace pointplane
