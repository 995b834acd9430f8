// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>

#include <Eigen/Cholesky>

#include <map>

#include "SolutionAnalysis.h"
#include "sorted_by_feature.h"

namespace pointplane
{
namespace
{
/** Change of the solution with pose and velocity of each reference, by these pairs. The pose moves
 * all of its features alike; what the velocity moves them by differs from row to row. */
template <class Pairs>
std::map<int, Matrix12d> withReferences(
    const Solution& at, const Solution::References& references, const Pairs& pairs, size_t offset)
{
    std::map<int, Matrix12d> out;
    for (const auto& [reference, sum] : references)
    {
        Matrix12d& change = out[reference] = sum.H;
        change.rightCols<6>().setZero();
    }
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        Matrix12d& change = out[pairs[i].reference];
        change.rightCols<6>() -= at.equations.influence(offset + i) *
                                 at.equations.residual(offset + i).ofReferenceVelocity;
    }
    for (auto& [reference, change] : out)
    {
        change = (at.H_inverse * change).eval();
    }
    return out;
}

/** With all depths of a patch larger by the part s, a point P of it becomes (1 + s) P. */
void addPatches(const Solution& at, Sensitivity& out)
{
    for (size_t i = 0; i < at.problem.points.size(); ++i)
    {
        const PointPair& pair = at.problem.points[i];
        if (pair.refPatch < 0 || pair.curPatch < 0 || !at.equations.isUsable(i))
        {
            continue;
        }
        const Matrix123d influence = at.equations.influence(i);
        const Eigen::Vector3d ofRef = pair.dRef_dCamera.col(kDepthScale);
        out.referencePatches.emplace(pair.reference, MotionByPatches::Zero())
            .first->second.col(pair.refPatch) -= influence * ofRef;
        out.patches.col(pair.curPatch) +=
            influence * (ofRef - at.equations.residual(i).ofCamera.col(kDepthScale));
    }
    out.patches = (at.H_inverse * out.patches).eval();
    for (auto& [reference, change] : out.referencePatches)
    {
        change = (at.H_inverse * change).eval();
    }
}

/** Covariance of the gradient by the current frame's features, as propagated: Gamma in
 * docs/theory.md. A feature that is compared with several references errs in all these pairs alike.
 */
template <class Pairs>
Matrix12d currentNoise(const Solution& at, const Pairs& pairs, size_t offset)
{
    const auto order = sortedByFeature(pairs);
    Matrix12d out = Matrix12d::Zero();
    for (auto it = order.begin(); it != order.end();)
    {
        const int feature = it->first;
        Matrix123d ofUnitNoise = Matrix123d::Zero();
        for (; it != order.end() && it->first == feature; ++it)
        {
            const size_t i = offset + it->second;
            const Eigen::LLT<Eigen::Matrix3d> root(at.equations.residual(i).curCov);
            if (root.info() == Eigen::Success)
            {
                ofUnitNoise += at.equations.influence(i) * Eigen::Matrix3d(root.matrixL());
            }
        }
        out += ofUnitNoise * ofUnitNoise.transpose();
    }
    return out;
}
}  // namespace

Sensitivity sensitivityOf(const Solution& at)
{
    Sensitivity out;
    // Moving a reference one way, or the frame the other way, is the same.
    for (const auto& [reference, sum] : at.points)
    {
        out.pointsMoved -= (at.H_inverse * sum.H).leftCols<6>();
    }
    for (const auto& [reference, sum] : at.planes)
    {
        out.planesMoved -= (at.H_inverse * sum.H).leftCols<6>();
    }
    out.references = out.referencePoints = withReferences(at, at.points, at.problem.points, 0);
    for (const auto& [reference, change] :
         withReferences(at, at.planes, at.problem.planes, at.problem.points.size()))
    {
        out.references.emplace(reference, Matrix12d::Zero()).first->second += change;
    }
    addPatches(at, out);
    out.points = propagate(at.H_inverse, currentNoise(at, at.problem.points, 0));
    out.planes =
        propagate(at.H_inverse, currentNoise(at, at.problem.planes, at.problem.points.size()));
    return out;
}
}  // namespace pointplane
