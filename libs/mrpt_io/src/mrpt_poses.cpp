// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/system/datetime.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <utility>

namespace pointplane
{
namespace
{
constexpr std::int64_t kTicksPerSecond = 10'000'000;
constexpr std::int64_t kTicksTo1970 = 116'444'736'000'000'000;  // MRPT counts from 1601
constexpr int kTickDigits = 7;

/** The stamp of a damaged file may be any number: the earliest ones are moved into the range. */
[[nodiscard]] std::int64_t ticksSince1970(mrpt::Clock::time_point stamp)
{
    constexpr std::int64_t kEarliest = std::numeric_limits<std::int64_t>::min() + kTicksTo1970 + 1;
    const std::int64_t ticks = stamp.time_since_epoch().count();
    return std::max(ticks, kEarliest) - kTicksTo1970;
}

[[nodiscard]] mrpt::Clock::time_point fromTicksSince1970(std::int64_t ticks)
{
    return mrpt::Clock::time_point(mrpt::Clock::duration(ticks + kTicksTo1970));
}
}  // namespace

Eigen::Isometry3d opticalInBody()
{
    Eigen::Isometry3d T_body_optical = Eigen::Isometry3d::Identity();
    T_body_optical.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return T_body_optical;
}

mrpt::poses::CPose3D toMrpt(const Eigen::Isometry3d& T_a_b)
{
    return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T_a_b.matrix()));
}

Eigen::Isometry3d fromMrpt(const mrpt::poses::CPose3D& pose)
{
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = pose.getRotationMatrix().asEigen();
    T.translation() << pose.x(), pose.y(), pose.z();
    return T;
}

Matrix6d jacobianYprOfTangent(const Eigen::Isometry3d& T_a_b)
{
    const Eigen::Matrix3d R = T_a_b.linear();
    // R = Rz(yaw) Ry(pitch) Rx(roll).
    const double sinPitch = -R(2, 0);
    const double trueCosPitch = std::hypot(R(0, 0), R(1, 0));
    const double yaw = trueCosPitch > 1e-9 ? std::atan2(R(1, 0), R(0, 0)) : 0.0;
    const double cosPitch = std::max(trueCosPitch, 1e-4);
    const double c = std::cos(yaw), s = std::sin(yaw);
    Matrix6d J = Matrix6d::Zero();
    // exp(xi) moves the translation t by rho + omega x t.
    J.topLeftCorner<3, 3>().setIdentity();
    J.topRightCorner<3, 3>() = -hat(T_a_b.translation());
    // omega = yaw' e_z + pitch' R_z e_y + roll' R_z R_y e_x, solved for the rates.
    const Eigen::RowVector3d roll(c / cosPitch, s / cosPitch, 0);
    J.block<1, 3>(3, 3) = Eigen::RowVector3d(0, 0, 1) + sinPitch * roll;
    J.block<1, 3>(4, 3) << -s, c, 0;
    J.block<1, 3>(5, 3) = roll;
    return J;
}

mrpt::poses::CPose3DPDFGaussian toMrpt(const PoseGaussian& T_a_b)
{
    const Matrix6d cov = strictlyPositive(propagate(jacobianYprOfTangent(T_a_b.mean), T_a_b.cov));
    return {toMrpt(T_a_b.mean), mrpt::math::CMatrixDouble66(cov)};
}

PoseGaussian fromMrpt(const mrpt::poses::CPose3DPDFGaussian& pdf)
{
    PoseGaussian out;
    out.mean = fromMrpt(pdf.mean);
    const Matrix6d inverse = jacobianYprOfTangent(out.mean).inverse();
    out.cov = propagate(inverse, Matrix6d(pdf.cov.asEigen()));
    return out;
}

mrpt::math::CMatrixDouble66 optimizerInformation(const mrpt::poses::CPose3DPDFGaussian& edge)
{
    const PoseGaussian left = fromMrpt(edge);
    const Matrix6d cov = propagate(adjoint(left.mean.inverse()), left.cov);
    POINTPLANE_CHECK(isPositiveDefinite(cov), "the covariance of an edge is not positive definite");
    return mrpt::math::CMatrixDouble66(Matrix6d(cov.llt().solve(Matrix6d::Identity())));
}

double toSeconds(mrpt::Clock::time_point stamp)
{
    if (stamp == INVALID_TIMESTAMP)
    {
        return std::numeric_limits<double>::quiet_NaN();
    }
    return static_cast<double>(ticksSince1970(stamp)) / static_cast<double>(kTicksPerSecond);
}

mrpt::Clock::time_point fromSeconds(double seconds)
{
    if (std::isnan(seconds))
    {
        return INVALID_TIMESTAMP;
    }
    constexpr double kMaxTicks = 9e18;  // with kTicksTo1970 still a 64-bit number
    const double ticks = seconds * static_cast<double>(kTicksPerSecond);
    return fromTicksSince1970(std::llround(std::fmin(std::fmax(ticks, -kMaxTicks), kMaxTicks)));
}

std::string stampText(mrpt::Clock::time_point stamp)
{
    const std::int64_t ticks = ticksSince1970(stamp);
    const std::int64_t magnitude = std::abs(ticks);
    char text[48];
    std::snprintf(
        text,
        sizeof(text),
        "%s%lld.%07lld00",
        ticks < 0 ? "-" : "",
        static_cast<long long>(magnitude / kTicksPerSecond),
        static_cast<long long>(magnitude % kTicksPerSecond));
    return text;
}

namespace
{
/** For digits that are as many as those of another unit since 1970 (2001 to 2286), and those
 * behind their point. */
[[nodiscard]] std::string otherUnitOf(const std::string& digits, const std::string& fraction)
{
    constexpr std::size_t kSeconds = 10;
    const std::pair<std::size_t, const char*> units[] = {
        {3, "milliseconds"}, {6, "microseconds"}, {9, "nanoseconds"}};
    for (const auto& [more, unit] : units)
    {
        if (digits.size() == kSeconds + more)
        {
            return std::string("; if it is in ") + unit + ", write " + digits.substr(0, kSeconds) +
                   "." + digits.substr(kSeconds) + fraction;
        }
    }
    return "";
}
}  // namespace

mrpt::Clock::time_point stampFromText(const std::string& text)
{
    const std::size_t dot = std::min(text.find('.'), text.size());
    const std::string whole = text.substr(0, dot);
    std::string fraction = dot < text.size() ? text.substr(dot + 1) : "";
    const auto isDigits = [](const std::string& s)
    { return std::all_of(s.begin(), s.end(), [](unsigned char c) { return std::isdigit(c); }); };
    static const std::size_t kMostDigits = std::to_string(kLatestStamp).size();
    if (whole.empty() || whole.size() > kMostDigits || !isDigits(whole) || !isDigits(fraction))
    {
        throw InputError(
            "'" + text + "' is not a time stamp in seconds" +
            (isDigits(whole) && isDigits(fraction) ? otherUnitOf(whole, fraction) : ""));
    }
    const bool roundUp = fraction.size() > kTickDigits && fraction[kTickDigits] >= '5';
    fraction.resize(kTickDigits, '0');
    return fromTicksSince1970(
        std::stoll(whole) * kTicksPerSecond + std::stoll(fraction) + (roundUp ? 1 : 0));
}
}  // namespace pointplane
