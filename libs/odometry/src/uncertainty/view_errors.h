// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
/** Kernel of the error that all points of a frame share (eta in docs/theory.md).
 *
 * Depth, lens and scene are not quite what they are modelled as. So all points of a frame err
 * together, as if the camera stood elsewhere. Frames that see the scene alike err alike, and
 * nothing of it shows when they are compared; frames far apart err independently. So the error is
 * a stationary Gaussian process whose input is the view.
 * \param motion between the two frames
 * \param distance of the features [m]: a translation moves them in view like a turn by its part of
 * that
 * \param viewAngle of the camera [rad]: a turn by it shows nothing of what was in view before
 * \return correlation of their errors: exp(-(translation / distance + turn) / viewAngle) */
[[nodiscard]] double viewCorrelation(
    const Eigen::Isometry3d& motion, double distance, double viewAngle);

/** The same of planes (zeta). A turn by a part of the view puts them into another part of the
 * image, where their outlines differ. \return exp(-3 (translation / distance + turn) / viewAngle)
 */
[[nodiscard]] double planeViewCorrelation(
    const Eigen::Isometry3d& motion, double distance, double viewAngle);

/** How far away the features are [m]: where a rotation moves them as far as a translation of that
 * distance times the angle. \param information of the pose by all features, J^T W J */
[[nodiscard]] double featureDistance(const Matrix6d& information);

/** Standard deviation of the points' error, as one of the pose (left perturbation) [m, rad]: sigma
 * [rad] per axis of the rotation, and sigma times the features' distance [m] per axis of the
 * translation, which moves them as far.
 *
 * From row to row, and from colour to depth, features err as differently as from frame to frame.
 * Where these are exposed one after the other, this looks like a velocity: the last six components
 * [m/s, rad/s]. Zero if all is exposed at once. */
[[nodiscard]] Vector12d viewSigma(double sigma, double distance, const ShutterModel& shutter);
}  // namespace pointplane
