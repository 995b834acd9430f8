// SPDX-License-Identifier: BSD-3-Clause
#include "warped_patches.h"

#include <Eigen/LU>

#include <cmath>

namespace pointplane
{
namespace
{
constexpr double kScharrGain = 32;
constexpr int kIterations = 2;
constexpr float kFarthest_px = 2;

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

void WarpedPatches::add(
    const cv::Mat& gray,
    const cv::Mat& derivatives,
    const cv::Point2f& centre,
    int halfPx,
    Brightness brightness,
    const Directions& measured)
{
    const int side = 2 * halfPx + 1;
    const cv::Rect pixels =
        cv::Rect(cvRound(centre.x) - halfPx, cvRound(centre.y) - halfPx, side, side) &
        cv::Rect(0, 0, gray.cols, gray.rows);
    std::vector<Eigen::Vector2d> gradients;
    gradients.reserve(static_cast<std::size_t>(pixels.area()));
    Eigen::Vector2d mean(0, 0);
    const Patch patch{
        cv::Rect2f(cv::Rect(pixels.tl(), pixels.size() - cv::Size(1, 1))) - centre,
        pixels.width,
        pixels.height,
        samples_.size()};
    for (int v = pixels.y; v < pixels.br().y; ++v)
    {
        for (int u = pixels.x; u < pixels.br().x; ++u)
        {
            const auto& g = derivatives.at<cv::Vec2s>(v, u);
            gradients.emplace_back(g[0] / kScharrGain, g[1] / kScharrGain);
            mean += gradients.back() / pixels.area();
            samples_.push_back({static_cast<float>(gray.at<uchar>(v, u)), {0, 0}});
        }
    }
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    for (Eigen::Vector2d& g : gradients)
    {
        // What a shift of brightness could explain is no structure.
        g -= brightness == Brightness::Shifted ? mean : Eigen::Vector2d::Zero();
        normal += g * g.transpose();
    }
    const Eigen::Matrix2d ofGradient =
        measured * (measured.transpose() * normal * measured).inverse() * measured.transpose();
    for (std::size_t i = 0; i < gradients.size(); ++i)
    {
        samples_[patch.begin + i].gain = (-ofGradient * gradients[i]).cast<float>();
    }
    patches_.push_back(patch);
}

/** In the reference's image. */
Eigen::Vector2f WarpedPatches::step(
    const Patch& patch,
    const cv::Mat& image,
    const Eigen::Matrix2f& warp,
    const Eigen::Vector2f& position) const
{
    Eigen::Vector2f out(0, 0);
    const Sample* sample = samples_.data() + patch.begin;
    Eigen::Vector2f row = position + warp * Eigen::Vector2f(patch.pixels.x, patch.pixels.y);
    for (int y = 0; y < patch.rows; ++y, row += warp.col(1))
    {
        Eigen::Vector2f pixel = row;
        for (int x = 0; x < patch.columns; ++x, pixel += warp.col(0), ++sample)
        {
            out += sample->gain * (greyAt(image, pixel) - sample->grey);
        }
    }
    return out;
}

bool WarpedPatches::refine(
    std::size_t patch,
    const cv::Mat& image,
    const Eigen::Matrix2d& warp,
    cv::Point2f& position) const
{
    const Patch& p = patches_[patch];
    const Eigen::Matrix2f A = warp.cast<float>();
    const Eigen::Vector2f start(position.x, position.y);
    Eigen::Vector2f found = start;
    const auto isInside = [&](float x, float y)
    { return canSample(image, found + A * Eigen::Vector2f(x, y)); };
    for (int i = 0; i < kIterations; ++i)
    {
        const cv::Rect2f& r = p.pixels;
        if (!(isInside(r.x, r.y) && isInside(r.x + r.width, r.y) && isInside(r.x, r.y + r.height) &&
              isInside(r.x + r.width, r.y + r.height)))
        {
            return false;
        }
        found += A * step(p, image, A, found);
        if (!((found - start).norm() <= kFarthest_px))  // also for NaN
        {
            return false;
        }
    }
    position = {found.x(), found.y()};
    return true;
}
}  // namespace pointplane
