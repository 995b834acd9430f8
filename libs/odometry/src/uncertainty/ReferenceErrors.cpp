// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/odometry/uncertainty/ReferenceErrors.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** One view. Fitted by likelihood to true relative motions of five recordings, as are the other
 * two constants: docs/experiments.md. */
constexpr double kDistance = 0.15;  // [m]
constexpr double kAngle = 2.0;      // [rad]
constexpr double kTime = 1.0;       // [s], over which scenes change

/** Views over which errors become independent. */
constexpr double kReach = 4;

/** A rotation errs by this part of what would move the scene as far as the translation does. */
constexpr double kRotation = 0.5;

/** How far away [m] the features are: where a rotation moves them as far as a translation of that
 * distance times the angle. */
double distanceOf(const Matrix6d& information)
{
    const double ofTranslation = information.topLeftCorner<3, 3>().trace();
    const double ofRotation = information.bottomRightCorner<3, 3>().trace();
    return ofTranslation > 0 ? std::sqrt(ofRotation / (2 * ofTranslation)) : 1;
}

double variogram(double views) { return -kReach * std::expm1(-views / kReach); }
}  // namespace

double viewsBetween(const Eigen::Isometry3d& motion, double time)
{
    return motion.translation().norm() / kDistance + so3Log(motion.linear()).norm() / kAngle +
           std::abs(time) / kTime;
}

JointCovariance::DriftStep driftStep(double before, double after, double step)
{
    // Variances and covariance of the differences to the reference, over driftPerView().
    const double ofBefore = variogram(before), ofAfter = variogram(after);
    const double ofBoth = (ofBefore + ofAfter - variogram(step)) / 2;
    JointCovariance::DriftStep out;
    out.kept = ofBefore > 0 ? ofBoth / ofBefore : 0;
    out.gained = std::max(0.0, ofAfter - out.kept * ofBoth);
    out.whole = ofAfter;
    return out;
}

Matrix6d driftPerView(double sigma, const Matrix6d& information)
{
    const double ofTranslation = sigma * distanceOf(information), ofRotation = sigma * kRotation;
    Vector6d variances;
    variances << Eigen::Vector3d::Constant(ofTranslation * ofTranslation),
        Eigen::Vector3d::Constant(ofRotation * ofRotation);
    return variances.asDiagonal();
}
}  // namespace pointplane
