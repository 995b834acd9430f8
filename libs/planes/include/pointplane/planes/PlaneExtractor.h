// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/planes/CellGrid.h>
#include <pointplane/planes/PlaneClustering.h>
#include <pointplane/planes/PlaneFeature.h>
#include <pointplane/sensor/DepthNoise.h>

#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
/** Depth image -> planes with covariance: clustering of cells, merging of coplanar parts, pixel
 * labels, RANSAC filter (optional), weighted least squares. */
class PlaneExtractor
{
 public:
    struct TParams
    {
        int cellSizePx{10};
        double minValidFraction{0.7};
        double minPlaneFraction{0.01};
        double cellSigmas{2.5};
        double mergeSigmas{2.0};
        double stepSigmas{2.0};
        double slopePx{1.0};
        bool mergeCoplanarPlanes{true};
        bool ransac{false};
        std::string fitWeights{"inverseDepth"};
        double correlatedPixels{100.0};

        template <class V>
        void visit(V&& v)
        {
            v("cellSizePx", cellSizePx, "px", "side of the square cells that are clustered");
            v("minValidFraction", minValidFraction, "-", "of a cell's pixels that must have depth");
            v("minPlaneFraction",
              minPlaneFraction,
              "-",
              "smallest plane, as a fraction of the image");
            v("cellSigmas", cellSigmas, "-", "largest rms residual inside a cell, in sigmas");
            v("mergeSigmas", mergeSigmas, "-", "largest rms residual of a plane, in sigmas");
            v("stepSigmas", stepSigmas, "-", "largest rms step that a merge may bridge, in sigmas");
            v("slopePx", slopePx, "px", "lateral noise: widens the tolerance of slanted planes");
            v("mergeCoplanarPlanes",
              mergeCoplanarPlanes,
              "-",
              "join parts of one plane that are not adjacent");
            v("ransac",
              ransac,
              "-",
              "filter each plane's pixels by RANSAC before the fit (the paper)");
            v("fitWeights",
              fitWeights,
              "-",
              "inverseDepth (constant noise in 1/Z) or sigmaZ (the paper's w = sigma_Z^-2, in mm)");
            v("correlatedPixels",
              correlatedPixels,
              "px",
              "pixels whose depth errors act as one: the plane's covariance is this many times "
              "that of "
              "independent pixels");
        }
        void check() const;
    };

    PlaneExtractor(const TParams& params, const DepthNoise& noise);

    /** \param depth CV_32FC1 [m], NaN = no reading; an ideal pinhole's \return planes, largest
     * first */
    [[nodiscard]] PlaneSet extract(const cv::Mat& depth, const PinholeCamera& camera);

    /** For images from now on. */
    void setNoise(const DepthNoise& noise) { noise_ = noise; }

 private:
    [[nodiscard]] PlaneSet fitToCells(
        std::vector<CellCluster> clusters,
        const PlanarityTest& test,
        const cv::Mat& depth,
        const PinholeCamera& camera) const;
    [[nodiscard]] PlaneSet fitToPixels(
        const std::vector<CellCluster>& clusters,
        const PlanarityTest& test,
        const cv::Mat& depth,
        const PinholeCamera& camera) const;
    [[nodiscard]] std::optional<PlaneGaussian> fit(
        const std::vector<Eigen::Vector3d>& points, const std::vector<size_t>& inliers) const;
    [[nodiscard]] std::optional<PlaneFeature> feature(
        std::optional<PlaneGaussian> plane,
        const CellCluster& cells,
        double numPixels,
        cv::Size image) const;
    [[nodiscard]] double correlatedPixels(
        const PlaneMoments& plane, double numPixels, cv::Size image) const;

    TParams params_;
    DepthNoise noise_;
    CellGrid grid_;
};
}  // namespace pointplane
