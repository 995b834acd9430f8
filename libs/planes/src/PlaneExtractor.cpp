// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/range.h>
#include <pointplane/planes/PlaneClustering.h>
#include <pointplane/planes/PlaneExtractor.h>
#include <pointplane/planes/PlaneFitter.h>

#include <Eigen/LU>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "segment_pixels.h"

namespace pointplane
{
namespace
{
constexpr size_t kMaxPlanes = 255;  // labels are bytes

constexpr double kRansacSigmas = 3;
constexpr int kRansacDraws = 50;
constexpr std::uint32_t kRansacSeed = 1;

/** Part of the image over which what bends surfaces is one error. */
constexpr double kBentPart = 1.0 / 16;

Eigen::Matrix3d rowLever(const CellCluster& cluster, const CellGrid& grid, int height)
{
    Eigen::Matrix3d weighted = Eigen::Matrix3d::Zero();
    for (const int cell : cluster.cells)
    {
        const double centre = (cell / grid.cols + 0.5) * grid.cellSizePx;
        weighted += (centre / height - 0.5) * grid.moments[static_cast<size_t>(cell)].rayMatrix();
    }
    return cluster.moments.rayMatrix().inverse() * weighted;
}

/** Which cells a cluster's plane is fitted to: those that do not touch another cluster, because a
 * cell across an edge mixes two surfaces and yet looks planar (as the erosion of Feng et al. 2014).
 * All cells where hardly any would be left; none for a strip that is nothing but such cells. */
class EdgeErosion
{
 public:
    EdgeErosion(const std::vector<CellCluster>& clusters, const CellGrid& grid)
        : grid_(grid), clusterOfCell_(grid.moments.size(), -1)
    {
        for (size_t i = 0; i < clusters.size(); ++i)
        {
            for (const int cell : clusters[i].cells)
            {
                clusterOfCell_[static_cast<size_t>(cell)] = static_cast<int>(i);
            }
        }
    }

    [[nodiscard]] CellCluster eroded(const CellCluster& cluster) const
    {
        CellCluster out;
        out.fit = cluster.fit;
        for (const int cell : cluster.cells)
        {
            if (!touchesAnother(cell))
            {
                out.cells.push_back(cell);
                out.moments += grid_.moments[static_cast<size_t>(cell)];
            }
        }
        return out.cells.empty() || out.moments.numPixels > kMinFraction * cluster.moments.numPixels
                   ? out
                   : cluster;
    }

 private:
    static constexpr double kMinFraction = 0.25;

    [[nodiscard]] bool touchesAnother(int cell) const
    {
        const int own = clusterOfCell_[static_cast<size_t>(cell)];
        const int col = cell % grid_.cols, row = cell / grid_.cols;
        for (int r = std::max(0, row - 1); r <= std::min(grid_.rows - 1, row + 1); ++r)
        {
            for (int c = std::max(0, col - 1); c <= std::min(grid_.cols - 1, col + 1); ++c)
            {
                const int other = clusterOfCell_[static_cast<size_t>(r * grid_.cols + c)];
                if (other >= 0 && other != own)
                {
                    return true;
                }
            }
        }
        return false;
    }

    const CellGrid& grid_;
    std::vector<int> clusterOfCell_;  //!< -1 = none
};

/** Paints whole cells with their cluster's label, then, pixel by pixel, the cells at the clusters'
 * borders, which straddle two surfaces: each pixel goes to the nearest adjacent plane it fits. */
class LabelPainter
{
 public:
    LabelPainter(
        const CellGrid& grid,
        const cv::Mat& depth,
        const PinholeCamera& camera,
        const DepthNoise& noise)
        : grid_(grid),
          depth_(depth),
          camera_(camera),
          noise_(noise),
          labels_(depth.size(), CV_8UC1, cv::Scalar(0)),
          labelOfCell_(grid.moments.size(), 0)
    {
    }

    cv::Mat paint(const std::vector<CellCluster>& clusters, const PlanarityTest& test)
    {
        for (size_t i = 0; i < clusters.size(); ++i)
        {
            for (const int cell : clusters[i].cells)
            {
                labelOfCell_[static_cast<size_t>(cell)] = static_cast<uchar>(i + 1);
                paintCell(cell, static_cast<uchar>(i + 1));
            }
        }
        for (int cell = 0; cell < static_cast<int>(labelOfCell_.size()); ++cell)
        {
            if (labelOfCell_[static_cast<size_t>(cell)] == 0)
            {
                paintBorderCell(cell, clusters, test);
            }
        }
        return labels_;
    }

 private:
    [[nodiscard]] cv::Rect rect(int cell) const
    {
        const int s = grid_.cellSizePx;
        return {cell % grid_.cols * s, cell / grid_.cols * s, s, s};
    }

    void paintCell(int cell, uchar label)
    {
        const cv::Rect area = rect(cell);
        for (int v = area.y; v < area.y + area.height; ++v)
        {
            std::fill_n(labels_.ptr<uchar>(v) + area.x, area.width, label);
        }
    }

    /** Labels of the up to eight cells around, sorted, without repetition. */
    const std::vector<uchar>& adjacentLabels(int cell)
    {
        std::vector<uchar>& out = adjacent_;
        out.clear();
        const int col = cell % grid_.cols, row = cell / grid_.cols;
        for (int r = std::max(0, row - 1); r <= std::min(grid_.rows - 1, row + 1); ++r)
        {
            for (int c = std::max(0, col - 1); c <= std::min(grid_.cols - 1, col + 1); ++c)
            {
                const uchar label = labelOfCell_[static_cast<size_t>(r * grid_.cols + c)];
                if (label != 0 && std::find(out.begin(), out.end(), label) == out.end())
                {
                    out.push_back(label);
                }
            }
        }
        std::sort(out.begin(), out.end());
        return out;
    }

    void paintBorderCell(
        int cell, const std::vector<CellCluster>& clusters, const PlanarityTest& test)
    {
        const cv::Rect area = rect(cell);
        for (const uchar label : adjacentLabels(cell))
        {
            const Eigen::Vector3d& theta = clusters[static_cast<size_t>(label - 1)].fit.theta_m;
            const Eigen::Vector3d middle(
                (area.x + 0.5 * area.width - camera_.cx) / camera_.fx,
                (area.y + 0.5 * area.height - camera_.cy) / camera_.fy,
                1);
            const double limit =
                test.cellSigmas *
                std::sqrt(
                    noise_.inverseDepthVariance(theta.dot(middle)) + test.slopeSquared(theta));
            for (int v = area.y; v < area.y + area.height; ++v)
            {
                const float* z = depth_.ptr<float>(v);
                uchar* out = labels_.ptr<uchar>(v);
                const double base = theta.y() * (v - camera_.cy) / camera_.fy + theta.z();
                for (int u = area.x; u < area.x + area.width; ++u)
                {
                    const double error = base + theta.x() * (u - camera_.cx) / camera_.fx +
                                         1 / static_cast<double>(z[u]);
                    if (out[u] == 0 && std::abs(error) <= limit)
                    {
                        out[u] = label;
                    }
                }
            }
        }
    }

    const CellGrid& grid_;
    const cv::Mat& depth_;
    const PinholeCamera& camera_;
    const DepthNoise& noise_;
    cv::Mat labels_;
    std::vector<uchar> labelOfCell_;
    std::vector<uchar> adjacent_;  //!< memory of adjacentLabels()
};
}  // namespace

void PlaneExtractor::TParams::check() const
{
    checkRange("cellSizePx", cellSizePx, 4, 64);
    checkRange("minValidFraction", minValidFraction, 0.01, 1);
    checkRange("minPlaneFraction", minPlaneFraction, 1e-4, 1);
    checkRange("cellSigmas", cellSigmas, 0.1, 100);
    checkRange("mergeSigmas", mergeSigmas, 0.1, 100);
    checkRange("stepSigmas", stepSigmas, 0.1, 100);
    checkRange("slopePx", slopePx, 0, 100);
    checkRange("correlatedPixels", correlatedPixels, 1, 1e5);
    POINTPLANE_CHECK(
        fitWeights == "inverseDepth" || fitWeights == "sigmaZ",
        "fitWeights = " << fitWeights << " is neither inverseDepth nor sigmaZ");
}

PlaneExtractor::PlaneExtractor(const TParams& params, const DepthNoise& noise)
    : params_(params), noise_(noise)
{
    params_.check();
}

/** How many pixels err as one: some by their noise, many by what bends surfaces, each with its
 * share in the variance. */
double PlaneExtractor::correlatedPixels(
    const PlaneMoments& plane, double numPixels, cv::Size image) const
{
    if (noise_.isConstantInInverseDepth())
    {
        return params_.correlatedPixels;
    }
    const double share = noise_.relativeShare(plane.q / plane.n);
    const double bent = std::min(numPixels, kBentPart * image.area());
    return (1 - share) * params_.correlatedPixels + share * bent;
}

PlaneSet PlaneExtractor::extract(const cv::Mat& depth, const PinholeCamera& camera)
{
    PlanarityTest test;
    test.noise = noise_;
    test.bentPixels = kBentPart * static_cast<double>(depth.total());
    test.slopePx = params_.slopePx;
    test.focalLengthPx = std::abs(camera.fx);
    test.cellSigmas = params_.cellSigmas;
    test.mergeSigmas = params_.mergeSigmas;
    test.stepSigmas = params_.stepSigmas;

    grid_.compute(depth, camera, params_.cellSizePx);
    grid_.weigh(noise_);
    std::vector<CellCluster> clusters = clusterCells(
        grid_,
        test,
        params_.minValidFraction,
        params_.minPlaneFraction * static_cast<double>(depth.total()));
    if (params_.mergeCoplanarPlanes)
    {
        mergeCoplanar(clusters, test);
    }
    clusters.resize(std::min(clusters.size(), kMaxPlanes));

    return params_.ransac || params_.fitWeights == "sigmaZ"
               ? fitToPixels(clusters, test, depth, camera)
               : fitToCells(std::move(clusters), test, depth, camera);
}

PlaneSet PlaneExtractor::fitToCells(
    std::vector<CellCluster> clusters,
    const PlanarityTest& test,
    const cv::Mat& depth,
    const PinholeCamera& camera) const
{
    PlaneSet out;
    std::vector<CellCluster> kept;
    const EdgeErosion erosion(clusters, grid_);
    for (CellCluster& cluster : clusters)
    {
        const CellCluster core = erosion.eroded(cluster);
        const auto plane = feature(
            fitInverseDepth(core.moments, noise_), core, core.moments.numPixels, depth.size());
        if (plane)
        {
            out.planes.push_back(*plane);
            kept.push_back(std::move(cluster));
        }
    }
    out.labels = LabelPainter(grid_, depth, camera, noise_).paint(kept, test);
    return out;
}

/** [P17, section Plane Extraction]: RANSAC filters each detected plane, the inliers are what the
 * plane is fitted to and what it covers. */
PlaneSet PlaneExtractor::fitToPixels(
    const std::vector<CellCluster>& clusters,
    const PlanarityTest& test,
    const cv::Mat& depth,
    const PinholeCamera& camera) const
{
    const cv::Mat detected = LabelPainter(grid_, depth, camera, noise_).paint(clusters, test);
    const auto segments = pixelsOfSegments(detected, depth, camera, clusters.size());
    PlaneSet out;
    out.labels = cv::Mat(depth.size(), CV_8UC1, cv::Scalar(0));
    for (size_t k = 0; k < segments.size(); ++k)
    {
        const SegmentPixels& segment = segments[k];
        std::vector<size_t> inliers(segment.points.size());
        std::iota(inliers.begin(), inliers.end(), 0U);
        if (params_.ransac)
        {
            inliers =
                ransacInliers(segment.points, noise_, kRansacSigmas, kRansacDraws, kRansacSeed);
        }
        const auto numInliers = static_cast<double>(inliers.size());
        const auto plane =
            feature(fit(segment.points, inliers), clusters[k], numInliers, depth.size());
        if (plane)
        {
            out.planes.push_back(*plane);
            for (const size_t i : inliers)
            {
                out.labels.at<uchar>(segment.pixels[i]) = static_cast<uchar>(out.planes.size());
            }
        }
    }
    return out;
}

std::optional<PlaneGaussian> PlaneExtractor::fit(
    const std::vector<Eigen::Vector3d>& points, const std::vector<size_t>& inliers) const
{
    std::vector<Eigen::Vector3d> chosen;
    PlaneMoments moments;
    for (const size_t i : inliers)
    {
        const Eigen::Vector3d& P = points[i];
        chosen.push_back(P);
        const double q = 1 / P.z();
        moments.add(q * P.x(), q * P.y(), q, noise_.weight(q));
    }
    return params_.fitWeights == "sigmaZ" ? fitWeightedLeastSquares(chosen, noise_)
                                          : fitInverseDepth(moments, noise_);
}

/** \return nothing for what is no plane */
std::optional<PlaneFeature> PlaneExtractor::feature(
    std::optional<PlaneGaussian> plane,
    const CellCluster& cells,
    double numPixels,
    cv::Size image) const
{
    if (!plane || !(plane->theta_m.norm() > 1e-3) || !plane->cov_m.allFinite())
    {
        return std::nullopt;
    }
    plane->cov_m *= correlatedPixels(cells.moments, numPixels, image);
    return PlaneFeature{*plane, static_cast<int>(numPixels), rowLever(cells, grid_, image.height)};
}
}  // namespace pointplane
