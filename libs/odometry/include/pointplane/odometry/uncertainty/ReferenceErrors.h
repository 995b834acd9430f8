// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/uncertainty/JointCovariance.h>

namespace pointplane
{
/** How far apart two frames see the scene: 1 is another view, by 0.15 m, a turn of 2 rad or 1 s.
 * \param motion between them \param time [s] between them */
[[nodiscard]] double viewsBetween(const Eigen::Isometry3d& motion, double time);

/** How the error of what a reference says goes on from one frame to the next.
 *
 * It is the difference of a stationary Gaussian field between the view of the frame and that of the
 * reference. Between views d apart, the variance of such a difference is driftPerView() times
 * g(d) = L (1 - exp(-d / L)). Given its value at the previous frame, the one at the current frame
 * is `kept` times as large plus noise of `gained`. Straight away from the reference this is a
 * random walk that gains 1 per view; back at the reference's view nothing is left of it; many views
 * away it grows no more. \param before, after views of the previous and of the current frame from
 * the reference \param step views between these two */
[[nodiscard]] JointCovariance::DriftStep driftStep(double before, double after, double step);

/** Covariance of that error, one view away, as an error of the pose (left perturbation): (s L)^2
 * per axis of the translation and (s / 2)^2 per axis of the rotation, L the distance of the scene
 * as the pose feels it. \param sigma s \param information of the pose by all features, from which L
 * is known */
[[nodiscard]] Matrix6d driftPerView(double sigma, const Matrix6d& information);
}  // namespace pointplane
