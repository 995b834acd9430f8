// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/nees_interval.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace pointplane
{
struct NeesOptions
{
    double offset{0};  //!< added to the estimate's stamps [s]
    TruthAt truthAt{TruthAt::Interpolated};
    double truthSigmaTranslation{0};  //!< of each ground-truth pose, per axis [m]
    /** Of each ground-truth pose, about the axes x, y, z of its body [rad]. */
    Eigen::Vector3d truthSigmaRotation{Eigen::Vector3d::Zero()};
    /** The estimate's body in the ground truth's body frame (fixed); see withBody(). */
    Eigen::Isometry3d T_truth_body{Eigen::Isometry3d::Identity()};
};

/** One tested increment T_i_j of the estimate. */
struct NeesIncrement
{
    std::size_t i{0}, j{0};  //!< indices into the estimate
    /** log(truth * estimate^-1), in body frame i, [translation; rotation] [m, rad]. */
    Vector6d error{Vector6d::Zero()};
    /** Of that error: the increment's, and that of the ground truth at both ends. */
    Matrix6d cov{Matrix6d::Identity()};
    double nees{0};  //!< error^T cov^-1 error; its expectation is 6
};

/** Covariance of the increment i -> j (left perturbation, in body frame i) [m, rad].
 *
 * It is the one in Trajectory::sinceCovs, if it is there. Else increments count as independent, and
 * the poses' covariances grow by Sigma_{k+1} = Sigma_k + Ad(T_k) Q_k Ad(T_k)^T (compose()). Then
 * that of the increments from i to j is Ad(T_i)^-1 (Sigma_j - Sigma_i) Ad(T_i)^-T. */
[[nodiscard]] Matrix6d incrementCovariance(
    const Trajectory& estimate, std::size_t i, std::size_t j);

/** The covariance of an increment is not in the file, and does not follow from those of the poses.
 */
class UntoldCovariance : public std::runtime_error
{
 public:
    using std::runtime_error::runtime_error;
};

/** All increments of the given length that have ground truth at both ends, one per start pose.
 * Ground-truth noise N per pose (in the body frame) adds N + Ad(T_i_j) N Ad(T_i_j)^T.
 * \throws std::runtime_error if the estimate has no covariances or the trajectories do not overlap
 * \throws UntoldCovariance naming the stamps, if a covariance is not positive definite */
[[nodiscard]] std::vector<NeesIncrement> neesIncrements(
    const Trajectory& groundTruth,
    const Trajectory& estimate,
    const NeesInterval& interval,
    const NeesOptions& options);

/** What could be tested of a run. */
struct NeesRun
{
    struct Tested
    {
        NeesInterval interval;
        std::vector<NeesIncrement> increments;
    };
    std::vector<Tested> tested;
    std::vector<NeesInterval> untold;  //!< not tested: UntoldCovariance
    std::string note;  //!< for the user: which covariances are missing and what was tested instead;
                       //!< or empty
};

/** The increments of each interval. If the covariances of an interval are missing, the poses since
 * the first one are tested instead, once. \throws std::runtime_error as neesIncrements(), but not
 * UntoldCovariance */
[[nodiscard]] NeesRun neesRun(
    const Trajectory& groundTruth,
    const Trajectory& estimate,
    const std::vector<NeesInterval>& intervals,
    const NeesOptions& options);
}  // namespace pointplane
