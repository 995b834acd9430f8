// SPDX-License-Identifier: BSD-3-Clause
#include "DepthRegistration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pointplane
{
namespace
{
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
/** A reading that would cover more pixels of the target is next to its lens, or the intrinsics are
 * nonsense. */
constexpr double kMaxSplat_px = 50;

/** Change of inverse depth per pixel at a reading between two neighbours: the smaller of both
 * sides', so that an edge on one side does not count; 0 if they differ in sign, or beside a hole.
 */
[[nodiscard]] float gradient(float before, float at, float after)
{
    const float first = 1 / at - 1 / before, second = 1 / after - 1 / at;
    const float smaller = std::abs(first) < std::abs(second) ? first : second;
    return first * second > 0 ? smaller : 0.0F;  // false for NaN
}

/** Slopes per target pixel of what has these per source pixel: by the transposed inverse of the
 * steps, with the larger pivot. */
[[nodiscard]] Eigen::Vector2d slopesInTarget(
    const Eigen::Matrix2d& steps, double slopeU, double slopeV)
{
    Eigen::Vector2d first = steps.col(0), second = steps.col(1);
    if (std::abs(first.x()) < std::abs(second.x()))
    {
        first.swap(second);
        std::swap(slopeU, slopeV);
    }
    const double m = second.x() / first.x();
    const double perV = (slopeV - m * slopeU) / (second.y() - m * first.y());
    return {(slopeU - first.y() * perV) / first.x(), perV};
}

/** x as a whole number of [low, high]; NaN is low. */
[[nodiscard]] int indexWithin(int low, int high, double x)
{
    return static_cast<int>(std::fmin(std::fmax(x, low), high));
}
}  // namespace

DepthRegistration::DepthRegistration(
    const PinholeCamera& source,
    const PinholeCamera& target,
    const Eigen::Isometry3d& T_target_source)
    : source_(source), target_(target), translation_(T_target_source.translation())
{
    rays_.reserve(static_cast<std::size_t>(source.width) * static_cast<std::size_t>(source.height));
    for (int v = 0; v < source.height; ++v)
    {
        for (int u = 0; u < source.width; ++u)
        {
            const Eigen::Vector3d ray = source_.normalised({u, v}).homogeneous();
            rays_.push_back((T_target_source.linear() * ray).cast<float>());
        }
    }
}

Eigen::Matrix2d DepthRegistration::pixelSteps(int u, int v) const
{
    const auto ray = [&](int column, int row) -> Eigen::Vector2f
    {
        return rays_
            [static_cast<std::size_t>(row) * static_cast<std::size_t>(source_.width) +
             static_cast<std::size_t>(column)]
                .head<2>();
    };
    const int left = std::max(u - 1, 0), right = std::min(u + 1, source_.width - 1);
    const int above = std::max(v - 1, 0), below = std::min(v + 1, source_.height - 1);
    const Eigen::Vector2d f(target_.fx, target_.fy);
    Eigen::Matrix2d steps;
    steps << f.x() / source_.fx, 0, 0, f.y() / source_.fy;  // of a single column or row
    if (right > left)
    {
        const Eigen::Vector2f columns = ray(right, v) - ray(left, v);
        steps.col(0) = f.cwiseProduct(columns.cast<double>()) / static_cast<double>(right - left);
    }
    if (below > above)
    {
        const Eigen::Vector2f rows = ray(u, below) - ray(u, above);
        steps.col(1) = f.cwiseProduct(rows.cast<double>()) / static_cast<double>(below - above);
    }
    return steps;
}

void DepthRegistration::splat(const cv::Mat& depth, int u, int v, cv::Mat& out) const
{
    const float z = depth.at<float>(v, u);
    const std::size_t index =
        static_cast<std::size_t>(v) * static_cast<std::size_t>(source_.width) +
        static_cast<std::size_t>(u);
    const Eigen::Vector3d p = static_cast<double>(z) * rays_[index].cast<double>() + translation_;
    if (!(p.z() > 1e-3))
    {
        return;
    }
    const double inverse = 1 / p.z();
    const double centreU = target_.fx * p.x() * inverse + target_.cx;
    const double centreV = target_.fy * p.y() * inverse + target_.cy;
    // Size of one source pixel in the target, a little more against rounding at shared borders.
    const double zoom = static_cast<double>(z) * inverse;
    const Eigen::Matrix2d steps = zoom * pixelSteps(u, v);
    const Eigen::Vector2d size = 1.01 * steps.cwiseAbs().rowwise().sum();
    const double sizeU = size.x(), sizeV = size.y();
    const int firstU = indexWithin(0, out.cols, std::ceil(centreU - sizeU / 2));
    const int lastU = indexWithin(-1, out.cols - 1, std::floor(centreU + sizeU / 2));
    const int firstV = indexWithin(0, out.rows, std::ceil(centreV - sizeV / 2));
    const int lastV = indexWithin(-1, out.rows - 1, std::floor(centreV + sizeV / 2));
    const bool sensible = sizeU < kMaxSplat_px && sizeV < kMaxSplat_px;
    if (!sensible || firstU > lastU || firstV > lastV)
    {
        return;
    }
    const bool inside = u > 0 && v > 0 && u + 1 < depth.cols && v + 1 < depth.rows;
    const float slopeU =
        inside ? gradient(depth.at<float>(v, u - 1), z, depth.at<float>(v, u + 1)) : 0.0F;
    const float slopeV =
        inside ? gradient(depth.at<float>(v - 1, u), z, depth.at<float>(v + 1, u)) : 0.0F;
    const Eigen::Vector2d slopes = slopesInTarget(steps, slopeU, slopeV);
    const double perU = slopes.x(), perV = slopes.y();
    for (int row = firstV; row <= lastV; ++row)
    {
        auto* line = out.ptr<float>(row);
        for (int col = firstU; col <= lastU; ++col)
        {
            const double q = inverse + perU * (col - centreU) + perV * (row - centreV);
            const auto rendered = static_cast<float>(1 / q);
            if (rendered > 0 && !(line[col] <= rendered))  // also true where nothing is yet
            {
                line[col] = rendered;
            }
        }
    }
}

cv::Mat DepthRegistration::render(const cv::Mat& depth) const
{
    cv::Mat out(target_.height, target_.width, CV_32FC1, cv::Scalar(kNone));
    for (int v = 0; v < depth.rows; ++v)
    {
        const auto* line = depth.ptr<float>(v);
        for (int u = 0; u < depth.cols; ++u)
        {
            if (line[u] > 0)  // false for NaN
            {
                splat(depth, u, v, out);
            }
        }
    }
    return out;
}
}  // namespace pointplane
