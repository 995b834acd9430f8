// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/Verdict.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pointplane
{
namespace
{
/** Samples along the longer side of the image. */
constexpr int kGrid = 80;

/** A deviation of so many standard deviations of the sensor's noise is none. */
constexpr float kSigmas = 4;

/** Depth cameras err by as much of the distance, differently in different parts of the image. */
constexpr float kDistortion = 0.02F;

/** Deviation in depth that is none, at depth z [m]. */
float tolerance(float z, const DepthNoise& noise)
{
    const auto sigma = static_cast<float>(noise.sigmaZ(static_cast<double>(z)));
    return std::hypot(kSigmas * sigma, kDistortion * z);
}

struct DepthRange
{
    float nearest{std::numeric_limits<float>::infinity()}, farthest{0};
};

/** Readings of the 3x3 pixels around one. \pre the pixel is not at the border */
DepthRange rangeAround(const cv::Mat& depth, int u, int v)
{
    DepthRange out;
    for (int dv = -1; dv <= 1; ++dv)
    {
        const auto* row = depth.ptr<float>(v + dv) + u;
        for (int du = -1; du <= 1; ++du)
        {
            const float z = row[du];
            if (z > 0)  // false for NaN
            {
                out.nearest = std::min(out.nearest, z);
                out.farthest = std::max(out.farthest, z);
            }
        }
    }
    return out;
}
}  // namespace

SurfaceSamples::SurfaceSamples(const RgbdFrame& frame)
{
    const cv::Mat& depth = frame.depth;
    const int step = std::max(1, std::max(depth.cols, depth.rows) / kGrid);
    for (int v = std::max(1, step / 2); v + 1 < depth.rows; v += step)
    {
        for (int u = std::max(1, step / 2); u + 1 < depth.cols; u += step)
        {
            const float z = depth.at<float>(v, u);
            if (!(z > 0))
            {
                continue;
            }
            const DepthRange range = rangeAround(depth, u, v);
            if (range.farthest - range.nearest < 2 * kDistortion * z)
            {
                const Eigen::Vector2d xy = frame.camera.normalisedOfDepth({u, v});
                points_cam.emplace_back(
                    z * static_cast<float>(xy.x()), z * static_cast<float>(xy.y()), z);
            }
        }
    }
}

Agreement& Agreement::operator+=(const Agreement& other)
{
    agrees += other.agrees;
    hidden += other.hidden;
    vanished += other.vanished;
    return *this;
}

Agreement compareSurfaces(
    const SurfaceSamples& reference,
    const Eigen::Isometry3d& T_cur_ref,
    const RgbdFrame& current,
    const DepthNoise& noise,
    double slack_m)
{
    const Eigen::Isometry3f T = T_cur_ref.cast<float>();
    const auto fx = static_cast<float>(current.camera.fx),
               fy = static_cast<float>(current.camera.fy),
               cx = static_cast<float>(current.camera.cx),
               cy = static_cast<float>(current.camera.cy);
    Agreement out;
    for (const Eigen::Vector3f& p_ref : reference.points_cam)
    {
        const Eigen::Vector3f p = T * p_ref;
        if (!(p.z() > 0))
        {
            continue;
        }
        const float u = fx * p.x() / p.z() + cx + 0.5F, v = fy * p.y() / p.z() + cy + 0.5F;
        if (!(u >= 1 && v >= 1 && u < static_cast<float>(current.depth.cols - 1) &&
              v < static_cast<float>(current.depth.rows - 1)))
        {
            continue;
        }
        const DepthRange range =
            rangeAround(current.depth, static_cast<int>(u), static_cast<int>(v));
        if (range.farthest <= 0)
        {
            continue;
        }
        const float most = tolerance(p.z(), noise) + static_cast<float>(slack_m);
        if (range.farthest + most < p.z())
        {
            ++out.hidden;
        }
        else if (range.nearest - most > p.z())
        {
            ++out.vanished;
        }
        else
        {
            ++out.agrees;
        }
    }
    return out;
}
}  // namespace pointplane
