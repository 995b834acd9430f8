// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/view_errors.h>

#include <Eigen/Geometry>

#include <cmath>

namespace pointplane
{
namespace
{
/** A way over which errors become those of another view. Half and twice of it change little:
 * docs/experiments_archive.md, Errors by the view and how many points there are. */
constexpr double kDistance = 0.6;  // [m]

/** Part of the view in which planes are cut out alike. */
constexpr double kPlanePart = 1.0 / 3;

/** How far away [m] the features are: where a rotation moves them as far as a translation of that
 * distance times the angle. */
double distanceOf(const Matrix6d& information)
{
    const double ofTranslation = information.topLeftCorner<3, 3>().trace();
    const double ofRotation = information.bottomRightCorner<3, 3>().trace();
    return ofTranslation > 0 ? std::sqrt(ofRotation / (2 * ofTranslation)) : 1;
}

/** Standard deviation of when features are exposed [s]: in any row, of colour or of depth. */
double spreadOf(const ShutterModel& shutter)
{
    return std::hypot(shutter.readoutColour / std::sqrt(12.0), shutter.depthDelay / 2);
}
}  // namespace

double viewCorrelation(const Eigen::Isometry3d& motion, double viewAngle)
{
    const double turn = Eigen::AngleAxisd(motion.linear()).angle();
    return std::exp(-motion.translation().norm() / kDistance - turn / viewAngle);
}

double planeViewCorrelation(const Eigen::Isometry3d& motion, double viewAngle)
{
    return viewCorrelation(motion, kPlanePart * viewAngle);
}

Vector12d viewSigma(double sigma, const Matrix6d& information, const ShutterModel& shutter)
{
    const Vector6d ofPose = perAxis(sigma * distanceOf(information), sigma);
    const double spread = spreadOf(shutter);
    Vector12d out = Vector12d::Zero();
    out.head<6>() = ofPose;
    if (spread > 0)
    {
        out.tail<6>() = ofPose / spread;
    }
    return out;
}
}  // namespace pointplane
