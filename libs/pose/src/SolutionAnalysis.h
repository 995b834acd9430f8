// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseSolver.h>

#include <map>
#include <vector>

#include "NormalEquations.h"

namespace pointplane
{
/** What the residuals at a solution say besides the motion. Derivations: docs/theory.md, Pose. */
class SolutionAnalysis
{
 public:
    /** \param equations evaluated at the solution of the problem
     * \param H of all pairs and the prior */
    SolutionAnalysis(
        const NormalEquations& equations,
        const PoseProblem& problem,
        const Matrix12d& H,
        const Matrix12d& H_inverse);

    /** Of references and features; not of prior and camera. */
    [[nodiscard]] Sensitivity sensitivity() const;

    /** References with points and references with planes. */
    [[nodiscard]] size_t numGroups() const { return pointGroups_.size() + planeGroups_.size(); }

    /** Whether the references draw the pose apart by more than their covariances allow.
     * \param cov of the solution */
    [[nodiscard]] Disagreement pointDisagreement(const Matrix12d& cov) const;
    [[nodiscard]] Disagreement planeDisagreement(const Matrix12d& cov) const;

    /** Sets all that is about the camera's errors. */
    void addCamera(PoseAnalysis& out) const;

    /** See PoseSolver. */
    [[nodiscard]] double pointSupport() const;

    /** See PoseAnalysis. \param of sensitivity() */
    [[nodiscard]] double scatter(const Sensitivity& of) const;

    /** Of the pairs. */
    [[nodiscard]] std::vector<double> pointWeights() const;
    [[nodiscard]] std::vector<double> planeWeights() const;
    [[nodiscard]] PlaneResiduals planeResiduals() const;

 private:
    using Groups = std::map<int, FeatureSum>;  //!< by reference

    /** \param offset of the pairs' first residual */
    template <class Pairs>
    [[nodiscard]] Groups byReference(const Pairs& pairs, size_t offset) const;
    [[nodiscard]] CameraInformation withoutMotion(
        int reference, const NormalEquations::CameraColumns& columns) const;
    template <class Pairs>
    [[nodiscard]] std::map<int, Matrix12d> withReferences(
        const Groups& groups, const Pairs& pairs, size_t offset) const;
    void addPatches(Sensitivity& out) const;
    template <class Pairs>
    [[nodiscard]] Matrix12d currentNoise(const Pairs& pairs, size_t offset) const;
    [[nodiscard]] std::vector<double> weights(size_t begin, size_t end) const;
    [[nodiscard]] double effectivePoints(const Vector12d& direction) const;
    [[nodiscard]] Disagreement disagreementOf(const Groups& groups, const Matrix12d& cov) const;

    const NormalEquations& equations_;
    const PoseProblem& problem_;
    const Matrix12d& H_;
    const Matrix12d& H_inverse_;
    Groups pointGroups_, planeGroups_;
};
}  // namespace pointplane
