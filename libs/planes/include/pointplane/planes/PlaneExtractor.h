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
/** Finds the planes of a depth image, with covariances. Cells are clustered, coplanar parts merged,
 * pixels labelled, filtered by RANSAC (optional), and fitted by weighted least squares. */
class PlaneExtractor
{
 public:
    struct TParams
    {
        int cellSizePx{10};
        double minValidFraction{0.3};
        double minPlaneFraction{0.01};
        double cellSigmas{2.5};
        double mergeSigmas{2.0};
        double stepSigmas{2.0};
        double slopePx{1.0};
        bool mergeCoplanarPlanes{true};
        bool ransac{false};
        std::string fitWeights{"inverseDepth"};
        double correlatedPixels{0};

        template <class V>
        void visit(V&& v)
        {
            v("cellSizePx", cellSizePx, "px", "side of the square cells that are clustered");
            v("minValidFraction",
              minValidFraction,
              "-",
              "least fraction of a cell's pixels with depth");
            v("minPlaneFraction",
              minPlaneFraction,
              "-",
              "smallest plane, as a fraction of the image");
            v("cellSigmas",
              cellSigmas,
              "-",
              "largest rms residual of a cell, in sigmas of the depth noise");
            v("mergeSigmas", mergeSigmas, "-", "largest rms residual of a plane, likewise");
            v("stepSigmas",
              stepSigmas,
              "-",
              "largest rms step between two parts that are merged, likewise");
            v("slopePx",
              slopePx,
              "px",
              "lateral noise of depth: slanted planes are allowed larger residuals");
            v("mergeCoplanarPlanes",
              mergeCoplanarPlanes,
              "-",
              "join parts of one plane that do not touch");
            v("ransac",
              ransac,
              "-",
              "filter each plane's pixels by RANSAC before the fit (as in the paper)");
            v("fitWeights",
              fitWeights,
              "-",
              "weights of the fit: inverseDepth (noise is constant in 1/Z) or sigmaZ (the "
              "paper's w = sigma_Z^-2, in mm)");
            v("correlatedPixels",
              correlatedPixels,
              "px",
              "number of neighbouring pixels that err as one; a plane's covariance is multiplied "
              "by it; 0: learnt from the plane's residuals");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    /** \throws std::invalid_argument naming the key */
    PlaneExtractor(const TParams& params, const DepthNoise& noise);

    /** \param depth CV_32FC1 [m], NaN = no reading; of an ideal pinhole
     * \return planes in the camera frame, largest first */
    [[nodiscard]] PlaneSet extract(const cv::Mat& depth, const PinholeCamera& camera);

    /** Sets the noise of images from now on. */
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
        const cv::Size& image) const;
    [[nodiscard]] double pixelsThatErrAsOne(
        const PlaneGaussian& plane, const CellCluster& cells, double numPixels) const;

    TParams params_;
    DepthNoise noise_;
    CellGrid grid_;
};
}  // namespace pointplane
