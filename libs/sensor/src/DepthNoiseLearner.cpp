// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/DepthNoiseLearner.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "noise_at_depths.h"

namespace pointplane
{
namespace
{
constexpr int kCellPx = 10;
constexpr int kEveryCell = 3;          //!< in each direction
constexpr double kLeastValid = 0.95;   //!< of a cell
constexpr double kLeastDepth = 0.125;  // [m]

/** No reading counts as farther [m]. */
constexpr double kFarthest = 1e6;

/** At first every image counts; then, one in so many. */
constexpr long kFirstImages = 5, kEveryImage = 10;

/** What is kept of earlier images whenever one is added. */
constexpr double kKept = 0.95;

/** Least of these cells are planar even in cluttered scenes. */
constexpr double kPlanarCells = 0.25;

/** A cell sees that part of the noise that changes within it; what is correlated over more pixels
 * is about as much again. Measured between cells of 10 px and of 40 px on cameras of all kinds, and
 * what the least of a Kinect's cells have to its published noise. */
constexpr double kBeyondCell = 1.4;

/** By how much cameras other than structured light's bend a surface, of its distance: calibration,
 * several paths of light, upsampling. Data sheets and published measurements: 0.1 to 1 %. */
constexpr double kBend = 0.005;

/** Structured light: its disparities are multiples of 1/8 px, 2.9e-3 in 1/Z [1/m]. */
constexpr double kStructuredStep = 2.9e-3;
/** Below 0.7 of that lie 1 to 2 % of a Kinect's steps, and 18 % or more where there are no levels.
 */
constexpr double kFineShare = 0.08, kFineStep = 0.7, kLargestStep = 4;
constexpr double kLeastSteps = 200, kLeastCells = 20;

/** Noise of structured light over that which is given; between, something else. */
constexpr double kLessNoise = 0.5, kMoreNoise = 2;
/** Below this, an image was not measured: rounding to millimetres makes 0.3 mm. */
constexpr double kRenderedSigma = 1e-4;  // [m]

[[nodiscard]] double depthOfBin(int bin) { return kLeastDepth * std::exp2(0.5 * (bin + 0.5)); }

/** The image with 640 columns, or not many more. Large depth images are enlarged ones, whose
 * neighbours err alike: cells of few pixels would see too little of the noise. */
[[nodiscard]] cv::Mat thinned(const cv::Mat& depth)
{
    constexpr double kWidth_px = 640;
    const double factor = std::round(depth.cols / kWidth_px);
    cv::Mat out = depth;
    if (factor > 1)
    {
        cv::resize(depth, out, {}, 1 / factor, 1 / factor, cv::INTER_NEAREST);
    }
    return out;
}

/** Of its values, some lie between the least and the largest. Otherwise they are rounded to one or
 * two, which hides their noise. */
[[nodiscard]] bool hasThreeLevels(const cv::Mat& cell)
{
    float least = std::numeric_limits<float>::infinity(), largest = 0;
    const auto widen = [&](float z)
    {
        least = z < least ? z : least;
        largest = z > largest ? z : largest;
    };
    const auto isBetween = [&](float z) { return z > least && z < largest; };
    std::for_each(cell.begin<float>(), cell.end<float>(), widen);
    return std::any_of(cell.begin<float>(), cell.end<float>(), isBetween);
}

/** A quantile of a histogram of logarithms. \return 0 where it is empty */
template <class Histogram>
[[nodiscard]] double quantile(const Histogram& histogram, double share, double total)
{
    double below = 0;
    for (std::size_t i = 0; i < histogram.size(); ++i)
    {
        if (histogram[i] > 0 && below + histogram[i] >= share * total)
        {
            const double within = (share * total - below) / histogram[i];
            return kLeastSigma * std::exp2(0.25 * (static_cast<double>(i) + within));
        }
        below += histogram[i];
    }
    return 0;
}
}  // namespace

DepthNoiseLearner::DepthNoiseLearner(const DepthNoise& given) : given_(given), noise_(given)
{
    given.check();
    decide();
}

void DepthNoiseLearner::update(const cv::Mat& depth)
{
    if (given_.kind == "given" || (numImages_ >= kFirstImages && numImages_ % kEveryImage != 0))
    {
        ++numImages_;
        return;
    }
    const cv::Mat cells = thinned(depth);
    Counts image;
    const int stride = kEveryCell * kCellPx;
    for (int v = 0; v + kCellPx <= cells.rows; v += stride)
    {
        // Columns are shifted from row to row, so that a grid in the scene is no grid here.
        for (int u = v / stride % kEveryCell * kCellPx; u + kCellPx <= cells.cols; u += stride)
        {
            addCell(cells, u, v, image);
        }
    }
    if (std::any_of(image.cells.begin(), image.cells.end(), [](double n) { return n > 0; }))
    {
        ++numImages_;
        add(image);
        decide();
    }
}

void DepthNoiseLearner::add(const Counts& image)
{
    const auto follow = [](double& sum, double added) { sum = kKept * sum + added; };
    for (std::size_t bin = 0; bin < kNumDepths; ++bin)
    {
        for (std::size_t level = 0; level < kNumLevels; ++level)
        {
            follow(counts_.residuals[bin][level], image.residuals[bin][level]);
        }
        follow(counts_.cells[bin], image.cells[bin]);
    }
    follow(counts_.fineSteps, image.fineSteps);
    follow(counts_.steps, image.steps);
}

void DepthNoiseLearner::addCell(const cv::Mat& depth, int u0, int v0, Counts& counts)
{
    constexpr double kMiddle = 0.5 * (kCellPx - 1);
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double qq = 0;
    for (int v = 0; v < kCellPx; ++v)
    {
        const float* row = depth.ptr<float>(v0 + v) + u0;
        for (int u = 0; u < kCellPx; ++u)
        {
            if (row[u] > 0)  // false for NaN
            {
                const double q = 1 / static_cast<double>(row[u]);
                const Eigen::Vector3d x(1, u - kMiddle, v - kMiddle);
                A += x * x.transpose();
                b += x * q;
                qq += q * q;
            }
        }
    }
    const double n = A(0, 0);
    if (n < kLeastValid * kCellPx * kCellPx || !hasThreeLevels(depth({u0, v0, kCellPx, kCellPx})))
    {
        return;
    }
    addSteps(depth.ptr<float>(v0 + kCellPx / 2) + u0, kCellPx, counts);
    const Eigen::Vector3d plane = A.ldlt().solve(b);
    const double z = std::min(n / b(0), kFarthest);
    const double sigma = z * z * std::sqrt(std::max(0.0, qq - b.dot(plane)) / (n - 3));
    const auto bin = static_cast<int>(std::floor(2 * std::log2(z / kLeastDepth)));
    if (bin >= 0 && bin < kNumDepths)
    {
        const double level = 4 * std::log2(std::max(sigma, kLeastSigma) / kLeastSigma);
        const auto i = static_cast<std::size_t>(std::min(level, kNumLevels - 1.0));
        counts.residuals[static_cast<std::size_t>(bin)][i] += 1;
        counts.cells[static_cast<std::size_t>(bin)] += 1;
    }
}

void DepthNoiseLearner::addSteps(const float* row, int count, Counts& counts)
{
    for (int u = 0; u + 1 < count; ++u)
    {
        const double a = static_cast<double>(row[u]), b = static_cast<double>(row[u + 1]);
        const double step = std::abs(1 / a - 1 / b);
        if (a > kNearestStep && b > kNearestStep && step > 0 &&
            step < kLargestStep * kStructuredStep)
        {
            counts.steps += 1;
            counts.fineSteps += step < kFineStep * kStructuredStep ? 1 : 0;
        }
    }
}

bool DepthNoiseLearner::hasLevels() const
{
    return counts_.steps > kLeastSteps && counts_.fineSteps < kFineShare * counts_.steps;
}

std::vector<NoiseAtDepth> DepthNoiseLearner::measured() const
{
    std::vector<NoiseAtDepth> out;
    for (int bin = 0; bin < kNumDepths; ++bin)
    {
        const auto i = static_cast<std::size_t>(bin);
        const double cells = counts_.cells[i];
        if (cells >= kLeastCells)
        {
            const double sigma = quantile(counts_.residuals[i], kPlanarCells, cells);
            out.push_back({depthOfBin(bin), sigma, cells});
        }
    }
    return out;
}

std::string DepthNoiseLearner::judgedKind(const std::vector<NoiseAtDepth>& depths) const
{
    const std::vector<NoiseAtDepth> far = farOf(depths);
    const double level = noiseLevelOf(far, given_.sigmaInverseDepth);
    // Small images of active stereo have such levels, too, but more noise.
    if (hasLevels() && (far.empty() || level <= kMoreNoise))
    {
        return "structuredLight";
    }
    if (far.empty())
    {
        return "learn";  // nothing told it yet
    }
    if (std::any_of(
            far.begin(),
            far.end(),
            [](const NoiseAtDepth& at) { return at.sigma < kRenderedSigma; }))
    {
        return "rendered";
    }
    return level < kLessNoise || !growsLikeTriangulation(far) ? "timeOfFlight"
           : level > kMoreNoise                               ? "activeStereo"
                                                              : "structuredLight";
}

void DepthNoiseLearner::decide()
{
    noise_ = given_;
    if (given_.kind == "given")
    {
        return;
    }
    const std::vector<NoiseAtDepth> depths = measured();
    noise_.kind = given_.kind == "learn" ? judgedKind(depths) : given_.kind;
    noise_.sigmaDepth = noise_.sigmaRelative = 0;
    const bool isStructured = noise_.kind == "structuredLight";
    if (depths.empty() || noise_.kind == "rendered" ||
        (isStructured && (given_.kind != "learn" || hasLevels())))
    {
        return;
    }
    const VarianceFit fit(depths);
    const double half = std::exp2(0.25);  // of a bin
    noise_.learntFrom = depths.front().depth / half;
    noise_.learntTo = depths.back().depth * half;
    if (isStructured)
    {
        // Its size without its levels: another camera perhaps, with more noise than is known.
        noise_.sigmaInverseDepth =
            std::max(given_.sigmaInverseDepth, kBeyondCell * std::sqrt(fit.slopeAlone()));
        return;
    }
    const Eigen::Vector2d variance = fit.solution();
    noise_.sigmaRelative = kBend;
    noise_.sigmaDepth = kBeyondCell * std::sqrt(variance.x());
    if (noise_.kind == "timeOfFlight" || !farOf(depths).empty())
    {
        noise_.sigmaInverseDepth = std::max(1e-6, kBeyondCell * std::sqrt(variance.y()));
    }
}
}  // namespace pointplane
