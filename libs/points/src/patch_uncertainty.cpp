// SPDX-License-Identifier: BSD-3-Clause
#include "patch_uncertainty.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace pointplane
{
double imageNoise(const cv::Mat& gray)
{
    constexpr int kStep = 4;                 // every fourth pixel tells enough
    constexpr double kGain = 6;              // root of the mask's sum of squares
    constexpr double kMedianSigma = 0.6745;  // median of |x| for a standard normal x
    constexpr double kLeast = 0.3;           // rounding to whole grey levels
    std::vector<int> responses;
    responses.reserve(gray.total() / (kStep * kStep));
    for (int v = 1; v + 1 < gray.rows; v += kStep)
    {
        const uchar* above = gray.ptr<uchar>(v - 1);
        const uchar* here = gray.ptr<uchar>(v);
        const uchar* below = gray.ptr<uchar>(v + 1);
        for (int u = 1; u + 1 < gray.cols; u += kStep)
        {
            responses.push_back(std::abs(
                above[u - 1] - 2 * above[u] + above[u + 1] - 2 * here[u - 1] + 4 * here[u] -
                2 * here[u + 1] + below[u - 1] - 2 * below[u] + below[u + 1]));
        }
    }
    if (responses.empty())
    {
        return kLeast;
    }
    const auto middle = responses.begin() + static_cast<std::ptrdiff_t>(responses.size() / 2);
    std::nth_element(responses.begin(), middle, responses.end());
    return std::max(kLeast, *middle / kMedianSigma / kGain);
}

Eigen::Matrix2d PatchUncertainty::covariance(double limit_px) const
{
    constexpr double kUnmeasured = 1000;  // [px]
    Eigen::Vector2d sigma = sigma_px;
    for (double& s : sigma)
    {
        s = s <= limit_px ? s : kUnmeasured;
    }
    return axes * sigma.cwiseAbs2().asDiagonal() * axes.transpose();
}

Directions PatchUncertainty::measured(double limit_px) const
{
    if (worst() <= limit_px)
    {
        return axes;
    }
    return best() <= limit_px ? Directions(axes.col(1)) : Directions(2, 0);
}

Eigen::Vector2d PatchUncertainty::displacement(double limit_px) const
{
    return axes * (sigma_px.array() <= limit_px).select(ofBrightness_px, 0).matrix();
}

PatchUncertainty patchUncertainty(
    const cv::Mat& gray,
    const cv::Mat& derivatives,
    const cv::Point2f& centre,
    int windowPx,
    double noise,
    Brightness brightness)
{
    constexpr double kGain = 32;
    constexpr double kEdge = 7;
    constexpr double kNoiseGain = 2 * (3 * 3 + 10 * 10 + 3 * 3) / (kGain * kGain);
    const int half = windowPx / 2;
    const cv::Rect patch =
        cv::Rect(cvRound(centre.x) - half, cvRound(centre.y) - half, windowPx, windowPx) &
        cv::Rect(0, 0, derivatives.cols, derivatives.rows);
    Eigen::Matrix2d gradients = Eigen::Matrix2d::Zero();
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Vector2d ofBrightness = Eigen::Vector2d::Zero();
    for (int v = patch.y; v < patch.br().y; ++v)
    {
        const auto* row = derivatives.ptr<cv::Vec2s>(v);
        const auto* grey = gray.ptr<uchar>(v);
        for (int u = patch.x; u < patch.br().x; ++u)
        {
            const Eigen::Vector2d g(row[u][0] / kGain, row[u][1] / kGain);
            gradients += g * g.transpose();
            sum += g;
            ofBrightness -= grey[u] * g;
        }
    }
    if (brightness == Brightness::Shifted)
    {
        gradients -= sum * sum.transpose() / patch.area();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> es(gradients);
    PatchUncertainty out;
    out.axes = es.eigenvectors();
    for (int k = 0; k < 2; ++k)
    {
        const double structure = es.eigenvalues()[k] - kNoiseGain * noise * noise * patch.area();
        out.sigma_px[k] = structure > 0 ? noise * std::sqrt(2 / structure)
                                        : std::numeric_limits<double>::infinity();
    }
    if (brightness == Brightness::Constant)
    {
        out.ofBrightness_px = (out.axes.transpose() * ofBrightness).cwiseQuotient(es.eigenvalues());
    }
    if (out.worst() > kEdge * out.best())
    {
        out.sigma_px[0] = std::numeric_limits<double>::infinity();
    }
    return out;
}
}  // namespace pointplane
