// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

#include <optional>

namespace pointplane
{
/** Sums over pixels from which a plane is fitted in inverse depth. Those of a union of pixel sets
 * are the sums of theirs, and so is the fit exact.
 *
 * On a plane theta_m . P + 1 = 0. Divided by Z, with the ray r = (x, y, 1) and q = 1/Z, the
 * residual theta_m . r + q is linear in theta_m. Its noise is that of the inverse depth, which is
 * the same at every depth for structured light. */
struct PlaneMoments
{
    double n{0}, x{0}, y{0}, xx{0}, xy{0}, yy{0}, q{0}, xq{0}, yq{0}, qq{0};
    double numPixels{0};  //!< how many; n is the sum of their weights

    /** Multiplies the weight of all pixels. */
    PlaneMoments& operator*=(double weight);

    /** Adds one pixel. \param ray_x, ray_y normalised coordinates \param inverseDepth [1/m] */
    void add(double ray_x, double ray_y, double inverseDepth, double weight = 1);

    PlaneMoments& operator+=(const PlaneMoments& other);
    friend PlaneMoments operator+(PlaneMoments a, const PlaneMoments& b) { return a += b; }

    /** sum r r^T: the information about theta_m, times sigma^2. */
    [[nodiscard]] Eigen::Matrix3d rayMatrix() const;
};

/** Least-squares plane of a pixel set. */
struct MomentsFit
{
    Eigen::Vector3d theta_m{0, 0, -1};  //!< n / d [1/m]
    double sse{0};                      //!< sum of squared inverse-depth residuals [1/m^2]
};

/** \return nothing when the pixels do not span a plane (fewer than 3, or collinear). */
[[nodiscard]] std::optional<MomentsFit> fitPlane(const PlaneMoments& moments);
}  // namespace pointplane
