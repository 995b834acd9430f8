// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/uncertainty/JointCovariance.h>

namespace pointplane
{
/** How differently two frames see the scene. 1 is one view: 0.15 m, a turn of 2 rad, or 1 s.
 * \param motion, time [s] between them */
[[nodiscard]] double viewsBetween(const Eigen::Isometry3d& motion, double time);

/** How the error of what a reference says goes on from one frame to the next.
 *
 * The error is the difference of a stationary Gaussian field between the frame's view and the
 * reference's. If these are d views apart, its variance is driftPerView() times
 * g(d) = L (1 - exp(-d / L)) with L = 4. The error at the current frame is `kept` times that at the
 * previous one, plus noise of variance `gained`. Straight away from the reference this is a random
 * walk that gains 1 per view. Many views away it grows no more. Back at the reference's view
 * nothing is left of it. \param before, after views from the reference to the previous and to the
 * current frame \param step views between these two */
[[nodiscard]] JointCovariance::DriftStep driftStep(double before, double after, double step);

/** Covariance that this error gains per view, as an error of the pose (left perturbation) [m, rad]:
 * (sigma D)^2 per axis of the translation and (sigma / 2)^2 per axis of the rotation. D is the
 * distance of the features, which `information` tells.
 * \param information of the pose by all features, J^T W J */
[[nodiscard]] Matrix6d driftPerView(double sigma, const Matrix6d& information);
}  // namespace pointplane
