// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/nees.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace pointplane
{
/** Mean NEES per degree of freedom against its two-sided 95 % chi-square bounds. */
struct ConsistencyTest
{
    double nees{0};  //!< per degree of freedom; 1 is consistent
    double lower{0}, upper{0};
    /** Not if covariances are too large or too small to compute with. */
    [[nodiscard]] bool isJudged() const { return std::isfinite(nees); }
    [[nodiscard]] bool isOptimistic() const { return isJudged() && nees > upper; }
    [[nodiscard]] bool isConservative() const { return isJudged() && nees < lower; }
};

/** Consistency of one degree of freedom. */
struct AxisConsistency
{
    ConsistencyTest test;
    double meanError{0};  //!< [m or rad]
    double rmsError{0};   //!< [m or rad]
    double rmsSigma{0};   //!< what the covariance says [m or rad]
};

struct NeesResult
{
    NeesInterval interval;
    std::size_t increments{0};
    /** How many of them fit one after the other. Bounds are computed with this number, because
     * increments that overlap are not independent. */
    std::size_t independent{0};
    ConsistencyTest joint, translation, rotation;
    std::array<AxisConsistency, 6> axes;  //!< x y z rx ry rz in the body frame
    /** Eigenvalues (ascending) of the whitened errors' second moment: NEES per degree of freedom
     * along the most conservative to the most optimistic direction; all 1 if consistent. */
    Vector6d whitenedEigenvalues{Vector6d::Ones()};
    /** Direction of the most optimistic one, in whitened [x y z rx ry rz]. */
    Vector6d mostOptimistic{Vector6d::Zero()};
};

/** Why these increments cannot be tested: there are fewer than two. Empty if they can. */
[[nodiscard]] std::string problemOf(
    const std::vector<NeesIncrement>& increments, const NeesInterval& interval);

/** Pools the increments of one or more runs. \param independent see NeesResult
 * \throws std::runtime_error if they have a problem */
[[nodiscard]] NeesResult consistencyOf(
    const std::vector<NeesIncrement>& increments,
    std::size_t independent,
    const NeesInterval& interval);

/** How many of the increments, taken greedily in time, do not overlap. */
[[nodiscard]] std::size_t countIndependent(const std::vector<NeesIncrement>& increments);

/** "consistent", "optimistic", "conservative" or "cannot be judged" */
[[nodiscard]] std::string shortVerdict(const ConsistencyTest& test);

/** The same, with a reason: "optimistic: sigmas are too small by a factor of 3.2" */
[[nodiscard]] std::string verdict(const ConsistencyTest& test);
}  // namespace pointplane
