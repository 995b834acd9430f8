// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/points/PointFeature.h>
#include <pointplane/sensor/DepthNoise.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
/** Key points that have depth. */
struct LiftedPoints
{
    std::vector<PointFeature> points;
    std::vector<int> index;  //!< of each point in the list that was given (row of its descriptor)
};

/** Key point + depth image -> 3-D point with covariance, in the camera frame [P17 Eq. 1, 2].
 *
 * The ray is freed from lens distortion, and depth is read where the depth image sees that ray.
 * Depth comes from the nearest pixel, as in the paper, or from the 3x3 pixels around it as a
 * mixture of Gaussians (Dryanovski et al. 2013), whose sigma grows at depth edges. */
class PointLifter
{
 public:
    struct TParams
    {
        std::string depthModel{"mixture"};     //!< nearest | mixture
        double maxEdgeSigmas{20};              //!< 0: keep all
        double minDepth{0.02}, maxDepth{100};  //!< [m]

        template <class V>
        void visit(V&& v)
        {
            v("depthModel",
              depthModel,
              "-",
              "depth of a point: nearest (one reading, as in the paper) or mixture (of the "
              "3x3 readings around it)");
            v("maxEdgeSigmas",
              maxEdgeSigmas,
              "-",
              "a point is dropped if its 3x3 readings spread by more than this many sigma_Z; "
              "0 = never");
            v("minDepth", minDepth, "m", "nearer readings count as errors");
            v("maxDepth", maxDepth, "m", "farther readings count as errors");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    explicit PointLifter(const DepthNoise& noise) : PointLifter(TParams{}, noise) {}
    /** \throws std::invalid_argument naming the key */
    PointLifter(const TParams& params, const DepthNoise& noise);

    /** Sets the noise of points that are lifted from now on. */
    void setNoise(const DepthNoise& noise) { noise_ = noise; }

    /** \param uv_px raw pixel of the colour image
     * \return point in the camera frame [m]; nothing if there is no usable depth */
    [[nodiscard]] std::optional<PointFeature> lift(
        const RgbdFrame& frame, const Eigen::Vector2d& uv_px) const;

    /** A point without depth: anywhere along its ray. Its covariance leaves the depth open, so that
     * it counts across the ray only. \param z guessed depth [m], > 0 */
    [[nodiscard]] PointFeature onRay(
        const RgbdFrame& frame, const Eigen::Vector2d& uv_px, double z) const;

    /** The points that have usable depth. \param uv_px raw pixels of the colour image */
    [[nodiscard]] LiftedPoints liftAll(
        const RgbdFrame& frame, const std::vector<Eigen::Vector2d>& uv_px) const;

 private:
    TParams params_;
    DepthNoise noise_;
};
}  // namespace pointplane
