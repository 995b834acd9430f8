// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/PlaneFeature.h>
#include <pointplane/planes/PlaneMatcher.h>

#include <Eigen/Geometry>

#include <vector>

#include "ImageAligner.h"

namespace pointplane
{
/** Finds the motions between two frames that their planes allow, without a prediction. Two planes
 * that are not parallel tell the rotation, and the translation along their normals. A third plane,
 * or a point, tells the rest of it.
 *
 * Which plane is which is not known: every set of planes is laid over every set that encloses the
 * same angles. So there are many motions, of which at most one is right. */
class PlaneAligner
{
 public:
    /** \param alike planes whose angle is above maxNormalAngleDeg are not parallel, and those
     * within it and maxDistance are the same */
    explicit PlaneAligner(const PlaneMatcher::TParams& alike);

    /** \param points matched pairs; some may be wrong
     * \return T_cur_ref, those of the largest planes first; of motions that are alike the first */
    [[nodiscard]] std::vector<Eigen::Isometry3d> motions(
        const PlaneSet& ref, const PlaneSet& cur, const MatchedPoints& points) const;

    /** @name What counts as the same. Normals are unit vectors, distances in m.
     * @{ */
    [[nodiscard]] bool areParallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
    [[nodiscard]] bool isAcross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
    [[nodiscard]] bool areNear(double a, double b) const;
    [[nodiscard]] bool areAlike(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const;
    /** @} */

 private:
    double angle_, distance_;  //!< [rad], [m]
};
}  // namespace pointplane
