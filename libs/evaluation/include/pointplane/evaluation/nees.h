// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/rpe.h>

#include <array>
#include <stdexcept>
#include <string>

namespace pointplane
{
/** Length of the increments whose covariance is tested: frames or seconds. */
struct NeesInterval
{
    double delta{1};
    DeltaUnit unit{DeltaUnit::Frames};
    bool sinceStart{false};  //!< all increments from the first pose instead: the poses themselves
};

/** From "1f", "10f", "0.5s" or "start". \throws std::invalid_argument for anything else */
[[nodiscard]] NeesInterval neesIntervalFromName(const std::string& name);
[[nodiscard]] std::string nameOf(const NeesInterval& interval);

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

/** Empty if the covariances of all these increments are in the file; else a note that they are
 * right only if increments are independent. */
[[nodiscard]] std::string noteOnUntold(
    const Trajectory& estimate, const std::vector<NeesIncrement>& increments);

/** Mean NEES per degree of freedom against its two-sided 95 % chi-square bounds. */
struct ConsistencyTest
{
    double nees{0};  //!< per degree of freedom; 1 is consistent
    double lower{0}, upper{0};
    [[nodiscard]] bool isOptimistic() const { return nees > upper; }
    [[nodiscard]] bool isConservative() const { return nees < lower; }
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

/** Pools the increments of one or more runs. \param independent see NeesResult
 * \throws std::runtime_error if there are fewer than two */
[[nodiscard]] NeesResult consistencyOf(
    const std::vector<NeesIncrement>& increments,
    std::size_t independent,
    const NeesInterval& interval);

/** How many of the increments, taken greedily in time, do not overlap. */
[[nodiscard]] std::size_t countIndependent(const std::vector<NeesIncrement>& increments);

/** "consistent", "optimistic: sigmas are too small by a factor of 3.2" or "conservative: ..." */
[[nodiscard]] std::string verdict(const ConsistencyTest& test);

/** The trajectory of another frame rigidly attached to the moving body: poses * T_body_other. The
 * poses' covariances, being left perturbations, stay. */
[[nodiscard]] Trajectory withBody(Trajectory trajectory, const Eigen::Isometry3d& T_body_other);
}  // namespace pointplane
