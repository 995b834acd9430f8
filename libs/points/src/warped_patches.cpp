// SPDX-License-Identifier: BSD-3-Clause
#include "warped_patches.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr int kMostSteps = 4;
constexpr float kConverged_px = 0.02F;  // well below the noise of a position
constexpr float kFarthest_px = 2;
// What does not fit is much the same at neighbours: 2 x 2 pixels tell as much as one.
constexpr double kPixelsAlike = 4;

/** Bilinear. \pre canSample(image, pixel), up to rounding */
float greyAt(const cv::Mat& image, const Eigen::Vector2f& pixel)
{
    const int u = static_cast<int>(pixel.x()), v = static_cast<int>(pixel.y());
    const float a = pixel.x() - static_cast<float>(u), b = pixel.y() - static_cast<float>(v);
    const uchar* upper = image.data + static_cast<std::size_t>(v) * image.step[0] + u;
    const uchar* lower = upper + image.step[0];
    const float top = static_cast<float>(upper[0]) + a * static_cast<float>(upper[1] - upper[0]);
    const float bottom = static_cast<float>(lower[0]) + a * static_cast<float>(lower[1] - lower[0]);
    return top + b * (bottom - top);
}

bool canSample(const cv::Mat& image, const Eigen::Vector2f& pixel)
{
    constexpr float kRounding = 0.01F;  // sums of steps from one corner of a patch to another
    return pixel.x() >= kRounding && pixel.y() >= kRounding &&
           pixel.x() < static_cast<float>(image.cols - 1) - kRounding &&
           pixel.y() < static_cast<float>(image.rows - 1) - kRounding;
}
}  // namespace

void WarpedPatches::reserve(std::size_t patches, int halfPx)
{
    const auto side = static_cast<std::size_t>(2 * halfPx + 1);
    patches_.reserve(patches);
    samples_.reserve(patches * side * side);
}

void WarpedPatches::add(const Patch& patch, Brightness brightness, const Directions& measured)
{
    const cv::Rect& pixels = patch.pixels();
    const Eigen::Matrix2d ofGradient =
        measured * (measured.transpose() * patch.structure(brightness) * measured).inverse() *
        measured.transpose();
    patches_.push_back(
        {cv::Rect2f(cv::Rect(pixels.tl(), pixels.size() - cv::Size(1, 1))) - patch.centre(),
         pixels.width,
         pixels.height,
         samples_.size(),
         brightness == Brightness::Shifted,
         ofGradient.trace() / static_cast<double>(std::max<Eigen::Index>(1, measured.cols()))});
    const Eigen::Vector2d explained = patch.explained(brightness);
    for (Eigen::Index i = 0; i < patch.greys().size(); ++i)
    {
        const Eigen::Vector2d gain = -ofGradient * (patch.gradients().col(i) - explained);
        samples_.push_back({patch.greys()[i], gain.cast<float>()});
    }
}

WarpedPatches::Step WarpedPatches::step(
    const Samples& patch,
    const cv::Mat& image,
    const Eigen::Matrix2f& warp,
    const Eigen::Vector2f& position) const
{
    Step out;
    const Sample* sample = samples_.data() + patch.begin;
    Eigen::Vector2f row = position + warp * Eigen::Vector2f(patch.pixels.x, patch.pixels.y);
    for (int y = 0; y < patch.rows; ++y, row += warp.col(1))
    {
        Eigen::Vector2f pixel = row;
        for (int x = 0; x < patch.columns; ++x, pixel += warp.col(0), ++sample)
        {
            const float brighter = greyAt(image, pixel) - sample->grey;
            out.shift += sample->gain * brighter;
            out.sum += brighter;
            out.sumOfSquares += brighter * brighter;
        }
    }
    return out;
}

std::optional<double> WarpedPatches::refine(
    std::size_t patch,
    const cv::Mat& image,
    const Eigen::Matrix2d& warp,
    cv::Point2f& position) const
{
    const Samples& p = patches_[patch];
    const Eigen::Matrix2f A = warp.cast<float>();
    const Eigen::Vector2f start(position.x, position.y);
    Eigen::Vector2f found = start;
    Step last;
    const auto isInside = [&](float x, float y)
    { return canSample(image, found + A * Eigen::Vector2f(x, y)); };
    for (int i = 0; i < kMostSteps; ++i)
    {
        const cv::Rect2f& r = p.pixels;
        if (!(isInside(r.x, r.y) && isInside(r.x + r.width, r.y) && isInside(r.x, r.y + r.height) &&
              isInside(r.x + r.width, r.y + r.height)))
        {
            return {};
        }
        last = step(p, image, A, found);
        found += A * last.shift;
        if (!((found - start).norm() <= kFarthest_px))  // also for NaN
        {
            return {};
        }
        if (last.shift.norm() < kConverged_px)
        {
            break;
        }
    }
    position = {found.x(), found.y()};
    const auto pixels = static_cast<double>(p.rows * p.columns);
    const double mean = p.isShifted ? static_cast<double>(last.sum) / pixels : 0;
    const double variance = static_cast<double>(last.sumOfSquares) / pixels - mean * mean;
    return kPixelsAlike * std::max(0.0, variance) * p.ofGrey;
}

Likeness WarpedPatches::compare(
    std::size_t patch, const cv::Mat& image, const cv::Point2f& position) const
{
    constexpr int kHalfPx = kComparedPx / 2;
    const Samples& p = patches_[patch];
    const cv::Point centre(cvRound(-p.pixels.x), cvRound(-p.pixels.y));
    const cv::Rect inner =
        cv::Rect(centre - cv::Point(kHalfPx, kHalfPx), cv::Size(kComparedPx, kComparedPx)) &
        cv::Rect(0, 0, p.columns, p.rows);
    double a = 0, b = 0, aa = 0, ab = 0, bb = 0;
    for (int y = inner.y; y < inner.br().y; ++y)
    {
        for (int x = inner.x; x < inner.br().x; ++x)
        {
            const auto i = p.begin + static_cast<std::size_t>(y * p.columns + x);
            const Eigen::Vector2f pixel(
                position.x + p.pixels.x + static_cast<float>(x),
                position.y + p.pixels.y + static_cast<float>(y));
            const auto of = static_cast<double>(samples_[i].grey);
            const auto at = static_cast<double>(greyAt(image, pixel));
            a += of, b += at;
            aa += of * of, ab += of * at, bb += at * at;
        }
    }
    const double n = inner.area(), va = aa - a * a / n, vb = bb - b * b / n;
    return {va > 1 && vb > 1 ? (ab - a * b / n) / std::sqrt(va * vb) : 0, (b - a) / n};
}
}  // namespace pointplane
