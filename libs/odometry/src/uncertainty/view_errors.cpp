// SPDX-License-Identifier: BSD-3-Clause
#include "view_errors.h"

#include <Eigen/Geometry>

#include <cmath>

namespace pointplane
{
namespace
{
/** Of the angle of view, the part over which planes are cut out alike. */
constexpr double kPlanePart = 1.0 / 3;

/** Standard deviation of when features are exposed [s]: in any row, of colour or of depth. */
double spreadOf(const ShutterModel& shutter)
{
    return std::hypot(shutter.readoutColour / std::sqrt(12.0), shutter.depthDelay / 2);
}
}  // namespace

double featureDistance(const Matrix6d& information)
{
    const double ofTranslation = information.topLeftCorner<3, 3>().trace();
    const double ofRotation = information.bottomRightCorner<3, 3>().trace();
    return ofTranslation > 0 ? std::sqrt(ofRotation / (2 * ofTranslation)) : 1;
}

double viewCorrelation(const Eigen::Isometry3d& motion, double distance, double viewAngle)
{
    const double turn = Eigen::AngleAxisd(motion.linear()).angle();
    return std::exp(-(motion.translation().norm() / distance + turn) / viewAngle);
}

double planeViewCorrelation(const Eigen::Isometry3d& motion, double distance, double viewAngle)
{
    return viewCorrelation(motion, distance, kPlanePart * viewAngle);
}

Vector12d viewSigma(double sigma, double distance, const ShutterModel& shutter)
{
    const Vector6d ofPose = perAxis(sigma * distance, sigma);
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
