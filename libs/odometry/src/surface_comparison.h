// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/DepthNoise.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pointplane
{
/** Readings of some pixels of a depth image. */
struct DepthRange
{
    float nearest{std::numeric_limits<float>::infinity()}, farthest{0};  //!< [m]; farthest 0: none
};

/** Of the 3x3 pixels around one. \pre the pixel is not at the border */
inline DepthRange rangeAround(const cv::Mat& depth, int u, int v)
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

/** A depth image that surfaces seen from elsewhere are compared with. */
class ComparedDepth
{
 public:
    enum class Sight
    {
        Unseen,   //!< out of view, or no reading
        Agrees,   //!< there is a surface
        Hidden,   //!< there is something in front of it
        Vanished  //!< the image sees through it
    };

    /** \param T_here_other from the camera that saw the surfaces
     * \param slack_m what depths may differ by beside noise and distortion
     * \param slackShare and in proportion to depth */
    ComparedDepth(
        const RgbdFrame& frame,
        const Eigen::Isometry3d& T_here_other,
        const DepthNoise& noise,
        double slack_m,
        double slackShare = 0)
        : depth_(frame.depth),
          noise_(noise),
          T_(T_here_other.cast<float>()),
          fx_(static_cast<float>(frame.camera.fx)),
          fy_(static_cast<float>(frame.camera.fy)),
          cx_(static_cast<float>(frame.camera.cx)),
          cy_(static_cast<float>(frame.camera.cy)),
          slack_(static_cast<float>(slack_m)),
          slackShare_(static_cast<float>(slackShare))
    {
    }

    /** \param p_other a point of a surface, in the other camera [m] */
    [[nodiscard]] Sight operator()(const Eigen::Vector3f& p_other) const
    {
        const Eigen::Vector3f p = T_ * p_other;
        if (!(p.z() > 0))
        {
            return Sight::Unseen;
        }
        const float u = fx_ * p.x() / p.z() + cx_ + 0.5F, v = fy_ * p.y() / p.z() + cy_ + 0.5F;
        if (!(u >= 1 && v >= 1 && u < static_cast<float>(depth_.cols - 1) &&
              v < static_cast<float>(depth_.rows - 1)))
        {
            return Sight::Unseen;
        }
        const DepthRange range = rangeAround(depth_, static_cast<int>(u), static_cast<int>(v));
        if (range.farthest <= 0)
        {
            return Sight::Unseen;
        }
        const float most = tolerance(p.z());
        return range.farthest + most < p.z()  ? Sight::Hidden
               : range.nearest - most > p.z() ? Sight::Vanished
                                              : Sight::Agrees;
    }

 private:
    [[nodiscard]] float tolerance(float z) const
    {
        return static_cast<float>(noise_.sameDepth(static_cast<double>(z))) + slack_ +
               slackShare_ * z;
    }

    const cv::Mat& depth_;
    const DepthNoise& noise_;
    Eigen::Isometry3f T_;
    float fx_, fy_, cx_, cy_, slack_, slackShare_;
};

/** A thin grid of pixels over an image, none at the border. */
struct PixelGrid
{
    /** Along the longer side. */
    static constexpr int kSamples = 80;

    explicit PixelGrid(const cv::Size& image, int samples = kSamples)
        : step(std::max(1, std::max(image.width, image.height) / samples)),
          first(std::max(1, step / 2)),
          size(count(image.width), count(image.height))
    {
    }

    /** Half as dense: at 2 m, a hand is one cell. */
    [[nodiscard]] static PixelGrid coarse(const cv::Size& image)
    {
        return PixelGrid(image, kSamples / 2);
    }

    [[nodiscard]] cv::Point pixel(int column, int row) const
    {
        return {first + column * step, first + row * step};
    }

    int step, first;
    cv::Size size;

 private:
    /** Of pixels before the last one of `length`. */
    [[nodiscard]] int count(int length) const
    {
        return length > first + 1 ? (length - 2 - first) / step + 1 : 0;
    }
};

/** The surface at a pixel, in the camera's frame [m]; at depth jumps and holes none (z = 0): the
 * readings there belong to neither side. \pre the pixel is not at the border */
inline Eigen::Vector3f surfaceAt(
    const RgbdFrame& frame, const cv::Point& pixel, const DepthNoise& noise)
{
    const float z = frame.depth.at<float>(pixel);
    if (z > 0)
    {
        const DepthRange range = rangeAround(frame.depth, pixel.x, pixel.y);
        const auto most = static_cast<float>(noise.sameDepth(static_cast<double>(z)));
        if (range.farthest - range.nearest < most)
        {
            const Eigen::Vector2d xy = frame.camera.normalisedOfDepth(
                {static_cast<double>(pixel.x), static_cast<double>(pixel.y)});
            return {z * static_cast<float>(xy.x()), z * static_cast<float>(xy.y()), z};
        }
    }
    return Eigen::Vector3f::Zero();
}
}  // namespace pointplane
