// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/chi_square.h>
#include <pointplane/evaluation/consistency.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <stdexcept>

namespace pointplane
{
namespace
{
constexpr double kConfidence = 0.95;

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

double blockNees(const NeesIncrement& increment, int start)
{
    const Eigen::Vector3d e = increment.error.segment<3>(start);
    const Eigen::Matrix3d C = increment.cov.block<3, 3>(start, start);
    return e.dot(C.llt().solve(e));
}

/** Means over increments. */
struct Means
{
    double joint{0}, translation{0}, rotation{0};  //!< NEES
    Vector6d perAxis{Vector6d::Zero()};            //!< likewise
    Vector6d error{Vector6d::Zero()}, squaredError{Vector6d::Zero()}, variance{Vector6d::Zero()};
    Matrix6d whitenedSquare{Matrix6d::Zero()};
};

Means meansOf(const std::vector<NeesIncrement>& increments)
{
    const double n = static_cast<double>(increments.size());
    Means out;
    for (const NeesIncrement& increment : increments)
    {
        const Vector6d z = whitened(increment);
        const Vector6d e2 = increment.error.cwiseAbs2();
        out.joint += increment.nees / n;
        out.translation += blockNees(increment, 0) / n;
        out.rotation += blockNees(increment, 3) / n;
        out.perAxis += e2.cwiseQuotient(increment.cov.diagonal()) / n;
        out.error += increment.error / n;
        out.squaredError += e2 / n;
        out.variance += increment.cov.diagonal() / n;
        out.whitenedSquare += z * z.transpose() / n;
    }
    return out;
}
}  // namespace

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

std::string problemOf(const std::vector<NeesIncrement>& increments, const NeesInterval& interval)
{
    constexpr std::size_t kLeast = 2;
    return increments.size() >= kLeast
               ? ""
               : std::string(increments.empty() ? "no" : "only one") + " increment of " +
                     nameOf(interval) +
                     " has ground truth at both ends; at least two are needed (--interval "
                     "chooses other lengths)";
}

NeesResult consistencyOf(
    const std::vector<NeesIncrement>& increments,
    std::size_t independent,
    const NeesInterval& interval)
{
    if (const std::string problem = problemOf(increments, interval); !problem.empty())
    {
        throw std::runtime_error(problem);
    }
    const Means means = meansOf(increments);
    NeesResult out;
    out.interval = interval;
    out.increments = increments.size();
    out.independent = independent;
    out.joint = testOf(means.joint, 6, independent);
    out.translation = testOf(means.translation, 3, independent);
    out.rotation = testOf(means.rotation, 3, independent);
    for (std::size_t k = 0; k < 6; ++k)
    {
        const auto axis = static_cast<Eigen::Index>(k);
        out.axes[k].test = testOf(means.perAxis[axis], 1, independent);
        out.axes[k].meanError = means.error[axis];
        out.axes[k].rmsError = std::sqrt(means.squaredError[axis]);
        out.axes[k].rmsSigma = std::sqrt(means.variance[axis]);
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(means.whitenedSquare);
    // Fewer increments than directions have none in some; rounding may make that negative.
    out.whitenedEigenvalues = (es.eigenvalues().array() < 0).select(0, es.eigenvalues());
    out.mostOptimistic = es.eigenvectors().col(5);
    return out;
}

std::string shortVerdict(const ConsistencyTest& test)
{
    return !test.isJudged()        ? "cannot be judged"
           : test.isOptimistic()   ? "optimistic"
           : test.isConservative() ? "conservative"
                                   : "consistent";
}

std::string verdict(const ConsistencyTest& test)
{
    return !test.isJudged()
               ? "cannot be judged: NEES is not finite, as covariances are too large or too small"
           : test.isOptimistic()
               ? "optimistic: the stated standard deviations are too small by a factor of " +
                     numberText(std::sqrt(test.nees), 2)
           : test.isConservative()
               ? "conservative: the stated standard deviations are too large by a factor of " +
                     numberText(1 / std::sqrt(test.nees), 2)
               : "consistent";
}
}  // namespace pointplane
