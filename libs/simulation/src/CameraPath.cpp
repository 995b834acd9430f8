// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/simulation/CameraPath.h>
#include <pointplane/simulation/Random.h>

#include <cmath>

#include "two_pi.h"

namespace pointplane
{
namespace
{
Eigen::Matrix3d lookAlong(const Eigen::Vector3d& forward)
{
    const Eigen::Vector3d z = forward.normalized();
    const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
    Eigen::Matrix3d R;
    R << x, z.cross(x), z;
    return R;
}
}  // namespace

CameraPath::CameraPath(const CameraMotion& motion, double scale, std::uint64_t seed)
    : motion_(motion)
{
    Random random({seed, 0x9a7e});
    // An axis gets 1/3 of the mean square speed, each slow wave half of that: the rms of
    // A sin(w t) differentiated is A w / sqrt(2).
    for (int axis = 0; axis < 6; ++axis)
    {
        const bool turn = axis >= 3;
        const double slow =
            scale * (turn ? motion.handTurnRate : motion.handSpeed) / std::sqrt(3.0);
        const double tremor =
            scale * (turn ? motion.tremorTurnRate : motion.tremorSpeed) / std::sqrt(3.0);
        const std::array<double, kWaves> hertz{
            random.uniform(0.12, 0.3), random.uniform(0.3, 0.7), random.uniform(3, 6)};
        const std::array<double, kWaves> speed{slow, slow, tremor * std::sqrt(2.0)};
        for (std::size_t k = 0; k < kWaves; ++k)
        {
            Wave& wave = waves_[static_cast<std::size_t>(axis)][k];
            wave.omega = kTwoPi * hertz[k];
            wave.amplitude = speed[k] / wave.omega;
            wave.phase = random.uniform(0, kTwoPi);
        }
    }
}

double CameraPath::hand(int axis, double t) const
{
    double sum = 0;
    for (const Wave& wave : waves_[static_cast<std::size_t>(axis)])
    {
        sum += wave.amplitude * std::sin(wave.omega * t + wave.phase);
    }
    return sum;
}

Eigen::Isometry3d CameraPath::pose(double t) const
{
    Eigen::Vector3d arm = motion_.eye - motion_.target;
    const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d target = motion_.target + t * motion_.velocity;
    if (motion_.orbitAmplitude != 0)
    {
        const double angle = motion_.orbitAmplitude * std::sin(kTwoPi * t / motion_.orbitPeriod);
        arm = Eigen::AngleAxisd(angle, axis) * arm;
    }
    Eigen::Vector3d eye = target + arm;
    if (motion_.turnPeriod != 0)
    {
        arm = Eigen::AngleAxisd(kTwoPi * t / motion_.turnPeriod, axis) * arm;
        const Eigen::Vector3d outward(-arm.x(), -arm.y(), 0);
        eye += motion_.turnRadius * outward.normalized();
    }
    const Eigen::Matrix3d R_base = lookAlong(-arm);
    const Eigen::Vector3d shift(hand(0, t), hand(1, t), hand(2, t));
    const Eigen::Vector3d turn(hand(3, t), hand(4, t), hand(5, t));
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = R_base * so3Exp(turn);
    out.translation() = eye + R_base * shift;
    return out;
}
}  // namespace pointplane
