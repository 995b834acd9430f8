// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/CellGrid.h>
#include <pointplane/planes/PlaneClustering.h>

namespace pointplane
{
/** How many pixels of a plane err as one: the factor on a covariance that counts them as
 * independent.
 *
 * Depth is wrong by patches: filters smooth it, lenses and projectors bend it. Then the mean
 * residual of a part of the plane is larger than independent pixels would make it. The plane is cut
 * into blocks, and their means are compared with that (batch means; as a covariance, Liang and
 * Zeger 1986). A smooth error that is plane itself does not show. Derivation: docs/theory.md,
 * Planes.
 * \param plane cells of the plane, with weighted moments
 * \param cov_m covariance of its parameters with independent pixels [1/m^2]
 * \return at least 1 */
[[nodiscard]] double correlatedPixels(
    const CellCluster& plane,
    const CellGrid& grid,
    const Eigen::Vector3d& theta_m,
    const Eigen::Matrix3d& cov_m);
}  // namespace pointplane
