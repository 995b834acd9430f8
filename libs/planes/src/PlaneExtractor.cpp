// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/patches.h>
#include <pointplane/core/range.h>
#include <pointplane/planes/PlaneClustering.h>
#include <pointplane/planes/PlaneExtractor.h>
#include <pointplane/planes/PlaneFitter.h>
#include <pointplane/sensor/readout.h>

#include <Eigen/LU>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "EdgeErosion.h"
#include "correlated_pixels.h"
#include "label_painting.h"
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
constexpr double kBentPart = 1.0 / kNumPatches;

/** PlaneFeature::readoutLever */
Eigen::Matrix3d leverOf(const CellCluster& cluster, const CellGrid& grid, const cv::Size& image)
{
    Eigen::Matrix3d weighted = Eigen::Matrix3d::Zero();
    for (const int cell : cluster.cells)
    {
        const Eigen::Vector2d centre_px =
            grid.cellSizePx * Eigen::Vector2d(cell % grid.cols + 0.5, cell / grid.cols + 0.5);
        weighted +=
            readoutFraction(centre_px, image) * grid.moments[static_cast<size_t>(cell)].rayMatrix();
    }
    return cluster.moments.rayMatrix().inverse() * weighted;
}
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
    checkRange("correlatedPixels", correlatedPixels, 0, 1e5);
    POINTPLANE_CHECK(
        fitWeights == "inverseDepth" || fitWeights == "sigmaZ",
        "fitWeights = " << fitWeights << " is neither inverseDepth nor sigmaZ");
}

PlaneExtractor::PlaneExtractor(const TParams& params, const DepthNoise& noise)
    : params_(params), noise_(noise)
{
    params_.check();
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
    out.labels = paintLabels(kept, grid_, depth, camera, test);
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
    const cv::Mat detected = paintLabels(clusters, grid_, depth, camera, test);
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

/** As the residuals tell; at least as many as the camera's kind says. */
double PlaneExtractor::pixelsThatErrAsOne(
    const PlaneGaussian& plane, const CellCluster& cells, double numPixels) const
{
    if (params_.correlatedPixels > 0)
    {
        return params_.correlatedPixels;
    }
    const double numCells = static_cast<double>(grid_.moments.size());
    const double area = numCells * grid_.cellSizePx * grid_.cellSizePx;
    const double bent = noise_.relativeShare(cells.moments.q / cells.moments.n) *
                        std::min(numPixels, kBentPart * area);
    return std::max(bent, correlatedPixels(cells, grid_, plane.theta_m, plane.cov_m));
}

/** \return nothing for what is no plane */
std::optional<PlaneFeature> PlaneExtractor::feature(
    std::optional<PlaneGaussian> plane,
    const CellCluster& cells,
    double numPixels,
    const cv::Size& image) const
{
    if (!plane || !(plane->theta_m.norm() > 1e-3))
    {
        return std::nullopt;
    }
    plane->cov_m *= pixelsThatErrAsOne(*plane, cells, numPixels);
    if (!plane->cov_m.allFinite())
    {
        return std::nullopt;
    }
    return PlaneFeature{*plane, static_cast<int>(numPixels), leverOf(cells, grid_, image)};
}
}  // namespace pointplane
