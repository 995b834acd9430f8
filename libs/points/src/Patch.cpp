// SPDX-License-Identifier: BSD-3-Clause
#include "Patch.h"

namespace pointplane
{
namespace
{
constexpr double kScharrGain = 32;

cv::Rect squareAround(const cv::Point2f& centre, int halfPx)
{
    const int side = 2 * halfPx + 1;
    return {cvRound(centre.x) - halfPx, cvRound(centre.y) - halfPx, side, side};
}
}  // namespace

Patch::Patch(const cv::Mat& gray, const cv::Mat& derivatives, const cv::Point2f& centre, int halfPx)
    : centre_(centre),
      halfPx_(halfPx),
      pixels_(squareAround(centre, halfPx) & cv::Rect(0, 0, gray.cols, gray.rows)),
      greys_(pixels_.area()),
      gradients_(2, pixels_.area())
{
    Eigen::Index i = 0;
    for (int v = pixels_.y; v < pixels_.br().y; ++v)
    {
        const auto* grey = gray.ptr<uchar>(v);
        const auto* derivative = derivatives.ptr<cv::Vec2s>(v);
        for (int u = pixels_.x; u < pixels_.br().x; ++u, ++i)
        {
            greys_[i] = static_cast<float>(grey[u]);
            gradients_.col(i) << derivative[u][0] / kScharrGain, derivative[u][1] / kScharrGain;
        }
    }
}

Patch Patch::inner(int halfPx) const
{
    Patch out;
    out.centre_ = centre_;
    out.halfPx_ = halfPx;
    out.pixels_ = squareAround(centre_, halfPx) & pixels_;
    const Eigen::Index columns = out.pixels_.width;
    out.greys_.resize(out.pixels_.area());
    out.gradients_.resize(2, out.pixels_.area());
    Eigen::Index from = (out.pixels_.y - pixels_.y) * pixels_.width + out.pixels_.x - pixels_.x;
    for (Eigen::Index to = 0; to < out.greys_.size(); to += columns, from += pixels_.width)
    {
        out.greys_.segment(to, columns) = greys_.segment(from, columns);
        out.gradients_.middleCols(to, columns) = gradients_.middleCols(from, columns);
    }
    return out;
}

Eigen::Vector2d Patch::explained(Brightness brightness) const
{
    return brightness == Brightness::Shifted ? Eigen::Vector2d(gradients_.rowwise().mean())
                                             : Eigen::Vector2d(0, 0);
}

Eigen::Matrix2d Patch::structure(Brightness brightness) const
{
    const Eigen::Vector2d mean = explained(brightness);
    Eigen::Matrix2d out = gradients_.lazyProduct(gradients_.transpose());
    out -= pixels_.area() * mean * mean.transpose();
    return out;
}

double Patch::structureOfNoise(double noise) const
{
    constexpr double kNoiseGain = 2 * (3 * 3 + 10 * 10 + 3 * 3) / (kScharrGain * kScharrGain);
    return kNoiseGain * noise * noise * pixels_.area();
}
}  // namespace pointplane
