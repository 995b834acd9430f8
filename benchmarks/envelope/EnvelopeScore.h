// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "methods.h"
#include "sequences.h"

namespace pointplane
{
/** One increment of an odometry beside the truth. */
struct ScoredStep
{
    std::size_t run{0}, frame{0};  //!< of the condition; frame of the run
    double stamp{0};               //!< of the frame [s]
    double errorTranslation{0};    //!< norm [m]; without truth: the step itself
    double errorRotation{0};       //!< [rad]; likewise
    double sigmaTranslation{0};    //!< largest claimed, truth included [m]; 0 = none claimed
    double sigmaRotation{0};       //!< [rad]
    double nees{0};                //!< per degree of freedom; 0 = no covariance
    bool isBeyond{false};          //!< see isBeyondFiveSigma(); or not positive definite
};

/** How one method did under one condition, all runs together. */
struct EnvelopeScore
{
    std::string sequence, condition, method;
    bool isPeer{false};
    Truth truth{Truth::Exact};
    std::string failure;                           //!< why it gave up, or empty
    std::size_t numSteps{0}, numTracked{0};        //!< frames after the first of a run
    std::size_t numPairs{0};                       //!< of poses a second apart
    double rpeTranslation{0}, rpeRotation{0};      //!< RMSE over 1 s [m, rad], if numPairs > 0
    double worstTranslation{0}, worstRotation{0};  //!< error of a tracked step [m, rad]
    double largestSigma{0};            //!< claimed by a tracked step, of translation [m]
    std::optional<double> neesMedian;  //!< per degree of freedom, of a tracked step
    std::optional<double> nees99;      //!< 99th percentile
    std::vector<ScoredStep> beyond;    //!< tracked steps beyond five standard deviations
    std::vector<ScoredStep> large;     //!< tracked steps with an error above 50 mm or 5 deg
};

/** An error that no honest covariance allows: along a principal axis of the translation's (the
 * rotation's) covariance more than five standard deviations and more than 10 mm (1 deg).
 * \param error, cov left tangent [translation; rotation] */
[[nodiscard]] bool isBeyondFiveSigma(const Vector6d& error, const Matrix6d& cov);

/** Pools the runs of one method under one condition. */
class EnvelopeScorer
{
 public:
    /** Keeps a reference. */
    explicit EnvelopeScorer(const BenchmarkSequence& sequence) : sequence_(sequence) {}

    /** \param stamps of the frames that were shown [s] \param steps one per frame */
    void add(const std::vector<double>& stamps, const std::vector<MethodStep>& steps);

    /** \param score names of sequence, condition and method, which are kept */
    [[nodiscard]] EnvelopeScore score(EnvelopeScore score) const;

 private:
    void addStep(const MethodStep& step, const Eigen::Isometry3d& truth, ScoredStep scored);
    void addPairs(
        const std::vector<double>& stamps,
        const std::vector<Eigen::Isometry3d>& poses,
        const SampledTruth& truth);

    const BenchmarkSequence& sequence_;
    std::size_t numRuns_{0}, numSteps_{0}, numTracked_{0}, numPairs_{0};
    double sumTranslation_{0}, sumRotation_{0};  //!< squares
    std::vector<ScoredStep> tracked_;            //!< those with truth, or all without any
};
}  // namespace pointplane
