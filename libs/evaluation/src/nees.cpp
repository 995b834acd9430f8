// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/chi_square.h>
#include <pointplane/evaluation/nees.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

namespace pointplane
{
namespace
{
constexpr double kConfidence = 0.95;

/** End of the increment that starts at i, if the estimate has one of about that length. */
std::optional<std::size_t> endOf(
    const Trajectory& estimate, std::size_t i, const NeesInterval& interval, double tolerance)
{
    if (interval.unit == DeltaUnit::Frames)
    {
        const auto j = i + static_cast<std::size_t>(interval.delta);
        return j < estimate.size() ? std::optional(j) : std::nullopt;
    }
    const double target = estimate.stamps[i] + interval.delta;
    const std::size_t j = nearestIndex(estimate.stamps, target);
    const bool fits = j > i && std::abs(estimate.stamps[j] - target) <= tolerance;
    return fits ? std::optional(j) : std::nullopt;
}

/** Ends of the increments, of the given length or all from the first pose. */
std::vector<std::pair<std::size_t, std::size_t>> endsOf(
    const Trajectory& estimate, const NeesInterval& interval)
{
    std::vector<std::pair<std::size_t, std::size_t>> out;
    const double tolerance = 0.5 * medianInterval(estimate) + 1e-6;
    for (std::size_t i = 0; i < estimate.size(); ++i)
    {
        if (interval.sinceStart && i > 0)
        {
            out.emplace_back(0, i);
        }
        else if (!interval.sinceStart)
        {
            if (const auto j = endOf(estimate, i, interval, tolerance))
            {
                out.emplace_back(i, *j);
            }
        }
    }
    return out;
}

ConsistencyTest testOf(double meanNees, std::size_t dof, std::size_t independent)
{
    const double n = static_cast<double>(independent * dof);
    ConsistencyTest test;
    test.nees = meanNees / static_cast<double>(dof);
    test.lower = chiSquareQuantile(0.5 * (1 - kConfidence), n) / n;
    test.upper = chiSquareQuantile(0.5 * (1 + kConfidence), n) / n;
    return test;
}

/** cov^-1/2 error, with the symmetric root so that axes keep their meaning. */
Vector6d whitened(const NeesIncrement& increment)
{
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(increment.cov);
    return es.operatorInverseSqrt() * increment.error;
}

bool isTold(const Trajectory& estimate, std::size_t i, std::size_t j)
{
    return j < estimate.sinceCovs.size() && j - i <= estimate.sinceCovs[j].size();
}

double blockNees(const NeesIncrement& increment, int start)
{
    const Eigen::Vector3d e = increment.error.segment<3>(start);
    const Eigen::Matrix3d C = increment.cov.block<3, 3>(start, start);
    return e.dot(C.llt().solve(e));
}
}  // namespace

NeesInterval neesIntervalFromName(const std::string& name)
{
    NeesInterval interval;
    if (name == "start")
    {
        interval.sinceStart = true;
        return interval;
    }
    const char* const end = name.data() + name.size();
    const auto [parsed, error] = std::from_chars(name.data(), end, interval.delta);
    const std::string unit(parsed, end);
    interval.unit = unit == "s" ? DeltaUnit::Seconds : DeltaUnit::Frames;
    const bool isWhole = interval.delta == std::floor(interval.delta);
    if (error != std::errc() || !(interval.delta > 0) || !std::isfinite(interval.delta) ||
        (unit != "s" && unit != "f") || (unit == "f" && !isWhole))
    {
        throw std::invalid_argument(
            "'" + name + "' is not an interval; frames or seconds, e.g. 1f, 10f or 1s, or start");
    }
    return interval;
}

std::string nameOf(const NeesInterval& interval)
{
    if (interval.sinceStart)
    {
        return "start";
    }
    char out[64];
    std::snprintf(out, sizeof out, "%g%s", interval.delta, nameOf(interval.unit).c_str());
    return out;
}

Matrix6d incrementCovariance(const Trajectory& estimate, std::size_t i, std::size_t j)
{
    if (isTold(estimate, i, j))
    {
        return estimate.sinceCovs[j][j - i - 1];
    }
    const Matrix6d Ad = adjoint(estimate.poses[i].inverse());
    return propagate(Ad, (estimate.covs[j] - estimate.covs[i]).eval());
}

std::vector<NeesIncrement> neesIncrements(
    const Trajectory& groundTruth,
    const Trajectory& estimate,
    const NeesInterval& interval,
    const NeesOptions& options)
{
    if (estimate.covs.size() != estimate.size())
    {
        throw std::runtime_error(
            "'" + estimate.name +
            "' has no covariances: give a rawlog or .simplemap with pose PDFs");
    }
    checkOverlap(groundTruth, estimate, options.offset);
    const SampledTruth truth =
        sampleTruth(groundTruth, estimate.stamps, options.offset, options.truthAt);

    Vector6d variances;
    variances.head<3>().setConstant(std::pow(options.truthSigmaTranslation, 2));
    variances.tail<3>() = options.truthSigmaRotation.cwiseAbs2();
    const Eigen::Isometry3d& T_truth_body = options.T_truth_body;
    const Matrix6d N = propagate(adjoint(T_truth_body.inverse()), Matrix6d(variances.asDiagonal()));

    std::vector<NeesIncrement> out;
    for (const auto& [i, j] : endsOf(estimate, interval))
    {
        if (truth.valid[i] == 0 || truth.valid[j] == 0)
        {
            continue;
        }
        NeesIncrement increment;
        increment.i = i;
        increment.j = j;
        const Eigen::Isometry3d T_estimate = estimate.poses[i].inverse() * estimate.poses[j];
        const Eigen::Isometry3d T_truth =
            (truth.poses[i] * T_truth_body).inverse() * (truth.poses[j] * T_truth_body);
        increment.error = se3Log(T_truth * T_estimate.inverse());
        const Matrix6d cov = incrementCovariance(estimate, i, j);
        if (!isPositiveDefinite(cov))
        {
            char stamps[128];
            std::snprintf(
                stamps, sizeof stamps, "%.6f to %.6f s", estimate.stamps[i], estimate.stamps[j]);
            throw UntoldCovariance(
                "'" + estimate.name + "': the covariance of the increment from " + stamps +
                " is not positive definite");
        }
        increment.cov = cov + N + propagate(adjoint(T_truth), N);
        increment.nees = increment.error.dot(increment.cov.llt().solve(increment.error));
        out.push_back(increment);
    }
    return out;
}

NeesRun neesRun(
    const Trajectory& groundTruth,
    const Trajectory& estimate,
    const std::vector<NeesInterval>& intervals,
    const NeesOptions& options)
{
    NeesRun out;
    std::string names;
    std::size_t longest = 1;
    for (const NeesInterval& interval : intervals)
    {
        try
        {
            out.tested.push_back(
                {interval, neesIncrements(groundTruth, estimate, interval, options)});
            out.note =
                out.note.empty() ? noteOnUntold(estimate, out.tested.back().increments) : out.note;
        }
        catch (const UntoldCovariance&)
        {
            out.untold.push_back(interval);
            names += (names.empty() ? "" : ", ") + nameOf(interval);
            for (const auto& [i, j] : endsOf(estimate, interval))
            {
                longest = std::max(longest, interval.sinceStart ? 1 : j - i);
            }
        }
    }
    if (!out.untold.empty())
    {
        NeesInterval start;
        start.sinceStart = true;
        out.tested.push_back({start, neesIncrements(groundTruth, estimate, start, options)});
        out.note = "increments of " + names + " are not tested: '" + estimate.name +
                   "' does not tell their covariances, and the poses' covariances do not grow by "
                   "them. Write them by pointplane-odometry --since " +
                   std::to_string(longest) +
                   ". The poses are tested instead, each as the motion since the first one";
    }
    return out;
}

std::string noteOnUntold(const Trajectory& estimate, const std::vector<NeesIncrement>& increments)
{
    const bool all = std::all_of(
        increments.begin(),
        increments.end(),
        [&](const NeesIncrement& increment) { return isTold(estimate, increment.i, increment.j); });
    if (all)
    {
        return "";
    }
    return "'" + estimate.name +
           "' does not tell the covariances of all these increments (pointplane-odometry --since); "
           "they are taken for the growth of the poses', which is right if increments are "
           "independent";
}

std::size_t countIndependent(const std::vector<NeesIncrement>& increments)
{
    std::size_t count = 0;
    std::size_t end = 0;
    for (const NeesIncrement& increment : increments)
    {
        if (count == 0 || increment.i >= end)
        {
            ++count;
            end = increment.j;
        }
    }
    return count;
}

NeesResult consistencyOf(
    const std::vector<NeesIncrement>& increments,
    std::size_t independent,
    const NeesInterval& interval)
{
    if (increments.size() < 2)
    {
        throw std::runtime_error(
            "only " + std::to_string(increments.size()) + " increment(s) of " + nameOf(interval) +
            " have ground truth at both ends; at least two are needed");
    }
    const double n = static_cast<double>(increments.size());
    double joint = 0;
    double translation = 0;
    double rotation = 0;
    Vector6d perAxis = Vector6d::Zero();
    Vector6d sum = Vector6d::Zero();
    Vector6d squares = Vector6d::Zero();
    Vector6d variances = Vector6d::Zero();
    Matrix6d secondMoment = Matrix6d::Zero();
    for (const NeesIncrement& increment : increments)
    {
        const Vector6d z = whitened(increment);
        const Vector6d e2 = increment.error.cwiseAbs2();
        joint += increment.nees / n;
        translation += blockNees(increment, 0) / n;
        rotation += blockNees(increment, 3) / n;
        perAxis += e2.cwiseQuotient(increment.cov.diagonal()) / n;
        sum += increment.error / n;
        squares += e2 / n;
        variances += increment.cov.diagonal() / n;
        secondMoment += z * z.transpose() / n;
    }
    NeesResult out;
    out.interval = interval;
    out.increments = increments.size();
    out.independent = independent;
    out.joint = testOf(joint, 6, independent);
    out.translation = testOf(translation, 3, independent);
    out.rotation = testOf(rotation, 3, independent);
    for (std::size_t k = 0; k < 6; ++k)
    {
        const auto axis = static_cast<Eigen::Index>(k);
        out.axes[k].test = testOf(perAxis[axis], 1, independent);
        out.axes[k].meanError = sum[axis];
        out.axes[k].rmsError = std::sqrt(squares[axis]);
        out.axes[k].rmsSigma = std::sqrt(variances[axis]);
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(secondMoment);
    out.whitenedEigenvalues = es.eigenvalues();
    out.mostOptimistic = es.eigenvectors().col(5);
    return out;
}

std::string verdict(const ConsistencyTest& test)
{
    char out[160] = "consistent";
    if (test.isOptimistic())
    {
        std::snprintf(
            out,
            sizeof out,
            "optimistic: the stated standard deviations are too small by a factor of %.2f",
            std::sqrt(test.nees));
    }
    else if (test.isConservative())
    {
        std::snprintf(
            out,
            sizeof out,
            "conservative: the stated standard deviations are too large by a factor of %.2f",
            1 / std::sqrt(test.nees));
    }
    return out;
}

Trajectory withBody(Trajectory trajectory, const Eigen::Isometry3d& T_body_other)
{
    for (Eigen::Isometry3d& pose : trajectory.poses)
    {
        pose = pose * T_body_other;
    }
    const Matrix6d Ad = adjoint(T_body_other.inverse());
    for (std::vector<Matrix6d>& covs : trajectory.sinceCovs)
    {
        for (Matrix6d& cov : covs)
        {
            cov = propagate(Ad, cov);
        }
    }
    return trajectory;
}
}  // namespace pointplane
