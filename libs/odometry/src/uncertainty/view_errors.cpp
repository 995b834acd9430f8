// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/view_errors.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** A way and a turn over which errors become those of another view. About half and twice of
 * them change little: docs/experiments_archive.md, Errors by the view and how many points there
 * are. */
constexpr double kDistance = 0.6;  // [m]
constexpr double kAngle = 1;       // [rad]

/** A turn that moves planes to other parts of the image: a third of a Kinect's view. */
constexpr double kPlaneAngle = 0.3;  // [rad]

/** Faster rows [s] do not show how fast a camera is. */
constexpr double kShortestReadout = 1e-3;

/** How far away [m] the features are: where a rotation moves them as far as a translation of that
 * distance times the angle. */
double distanceOf(const Matrix6d& information)
{
    const double ofTranslation = information.topLeftCorner<3, 3>().trace();
    const double ofRotation = information.bottomRightCorner<3, 3>().trace();
    return ofTranslation > 0 ? std::sqrt(ofRotation / (2 * ofTranslation)) : 1;
}

double correlation(const Eigen::Isometry3d& motion, double angle)
{
    const double turn = Eigen::AngleAxisd(motion.linear()).angle();
    return std::exp(-motion.translation().norm() / kDistance - turn / angle);
}
}  // namespace

double viewCorrelation(const Eigen::Isometry3d& motion) { return correlation(motion, kAngle); }

double planeViewCorrelation(const Eigen::Isometry3d& motion)
{
    return correlation(motion, kPlaneAngle);
}

Vector12d viewSigma(double sigma, const Matrix6d& information, double readout)
{
    const Vector6d ofPose = perAxis(sigma * distanceOf(information), sigma);
    // Standard deviation of when rows are exposed, all rows alike.
    const double spread = std::max(std::abs(readout), kShortestReadout) / std::sqrt(12.0);
    Vector12d out;
    out << ofPose, ofPose / spread;
    return out;
}
}  // namespace pointplane
