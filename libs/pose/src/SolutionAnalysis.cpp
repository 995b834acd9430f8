// SPDX-License-Identifier: BSD-3-Clause
#include "SolutionAnalysis.h"

#include <pointplane/core/covariance.h>
#include <pointplane/pose/median_variance.h>
#include <pointplane/pose/view_cell.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <limits>
#include <utility>

namespace pointplane
{
namespace
{
/** Of a direction about which a group knows less than this, as a part of what all know, it says
 * nothing. */
constexpr double kLeastShare = 0.03;

/** Where the pose follows planes in all but this part of their dimensions, their residuals tell
 * nothing of their noise. Three planes that alone tell the pose have a third left. */
constexpr double kLeastLeft = 0.25;

/** Side of a part of the view, over its distance: 11 degrees. Half to three times as much tells bad
 * frames as well. */
constexpr double kCell = 0.2;

/** Feature and index of all pairs, those of the same feature one after the other. */
template <class Pairs>
std::vector<std::pair<int, size_t>> sortedByFeature(const Pairs& pairs)
{
    std::vector<std::pair<int, size_t>> out;
    out.reserve(pairs.size());
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        const int own = -1 - static_cast<int>(i);
        out.emplace_back(pairs[i].feature < 0 ? own : pairs[i].feature, i);
    }
    std::sort(out.begin(), out.end());
    return out;
}
}  // namespace

SolutionAnalysis::SolutionAnalysis(
    const NormalEquations& equations,
    const PoseProblem& problem,
    const Matrix12d& H,
    const Matrix12d& H_inverse)
    : equations_(equations),
      problem_(problem),
      H_(H),
      H_inverse_(H_inverse),
      pointGroups_(byReference(problem.points, 0)),
      planeGroups_(byReference(problem.planes, problem.points.size()))
{
}

template <class Pairs>
SolutionAnalysis::Groups SolutionAnalysis::byReference(const Pairs& pairs, size_t offset) const
{
    Groups out;
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        equations_.add(out[pairs[i].reference], offset + i);
    }
    return out;
}

Sensitivity SolutionAnalysis::sensitivity() const
{
    Sensitivity out;
    // Moving a reference one way, or the frame the other way, is the same.
    for (const auto& [reference, group] : pointGroups_)
    {
        out.pointsMoved -= (H_inverse_ * group.H).leftCols<6>();
    }
    for (const auto& [reference, group] : planeGroups_)
    {
        out.planesMoved -= (H_inverse_ * group.H).leftCols<6>();
    }
    out.references = out.referencePoints = withReferences(pointGroups_, problem_.points, 0);
    for (const auto& [reference, change] :
         withReferences(planeGroups_, problem_.planes, problem_.points.size()))
    {
        out.references.emplace(reference, Matrix12d::Zero()).first->second += change;
    }
    addPatches(out);
    out.points = propagate(H_inverse_, currentNoise(problem_.points, 0));
    out.planes = propagate(H_inverse_, currentNoise(problem_.planes, problem_.points.size()));
    return out;
}

/** Change of the solution with pose and velocity of each reference, by these pairs. */
template <class Pairs>
std::map<int, Matrix12d> SolutionAnalysis::withReferences(
    const Groups& groups, const Pairs& pairs, size_t offset) const
{
    std::map<int, Matrix12d> out;
    for (const auto& [reference, group] : groups)
    {
        Matrix12d& change = out[reference] = group.H;
        change.rightCols<6>().setZero();
    }
    for (size_t i = 0; i < pairs.size(); ++i)
    {
        Matrix12d& change = out[pairs[i].reference];
        change.rightCols<6>() -=
            equations_.influence(offset + i) * equations_.residual(offset + i).ofReferenceVelocity;
    }
    for (auto& [reference, change] : out)
    {
        change = (H_inverse_ * change).eval();
    }
    return out;
}

/** With all depths of a patch larger by the part s, a point P of it becomes (1 + s) P. */
void SolutionAnalysis::addPatches(Sensitivity& out) const
{
    for (size_t i = 0; i < problem_.points.size(); ++i)
    {
        const PointPair& pair = problem_.points[i];
        if (pair.refPatch < 0 || pair.curPatch < 0)
        {
            continue;
        }
        const Matrix123d influence = equations_.influence(i);
        const Eigen::Vector3d ofRef = pair.dRef_dCamera.col(kDepthScale);
        out.referencePatches.emplace(pair.reference, MotionByPatches::Zero())
            .first->second.col(pair.refPatch) -= influence * ofRef;
        out.patches.col(pair.curPatch) +=
            influence * (ofRef - equations_.residual(i).ofCamera.col(kDepthScale));
    }
    out.patches = (H_inverse_ * out.patches).eval();
    for (auto& [reference, change] : out.referencePatches)
    {
        change = (H_inverse_ * change).eval();
    }
}

/** Covariance of the gradient by the current frame's features, as propagated. A feature that is
 * compared with several references errs in all these pairs alike. */
template <class Pairs>
Matrix12d SolutionAnalysis::currentNoise(const Pairs& pairs, size_t offset) const
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
            const Eigen::LLT<Eigen::Matrix3d> root(equations_.residual(i).curCov);
            if (root.info() == Eigen::Success)
            {
                ofUnitNoise += equations_.influence(i) * Eigen::Matrix3d(root.matrixL());
            }
        }
        out += ofUnitNoise * ofUnitNoise.transpose();
    }
    return out;
}

Disagreement SolutionAnalysis::pointDisagreement(const Matrix12d& cov) const
{
    return disagreementOf(pointGroups_, cov);
}

Disagreement SolutionAnalysis::planeDisagreement(const Matrix12d& cov) const
{
    return disagreementOf(planeGroups_, cov);
}

/** With scores s_g of covariance M_g, the solution leaves each group the gradient
 * g_g = s_g - H_g H^-1 sum(s), whose covariance is
 * M_g - H_g H^-1 M_g - M_g H^-1 H_g + H_g Sigma H_g (docs/theory.md, Noise of features). */
Disagreement SolutionAnalysis::disagreementOf(const Groups& groups, const Matrix12d& cov) const
{
    Disagreement out;
    for (const auto& [reference, group] : groups)
    {
        const Matrix12d shared = group.H * H_inverse_ * group.M;
        const Matrix12d covOfGradient =
            group.M - shared - shared.transpose() + group.H * cov * group.H;
        const Eigen::LDLT<Matrix6d> known((group.H + kLeastShare * H_).topLeftCorner<6, 6>());
        const Vector6d gradient = group.g.head<6>();
        out.observed += gradient.dot(known.solve(gradient));
        out.expected += known.solve(Matrix6d(covOfGradient.topLeftCorner<6, 6>())).trace();
    }
    return out;
}

void SolutionAnalysis::addCamera(PoseAnalysis& out) const
{
    NormalEquations::CameraColumns all;
    std::map<int, NormalEquations::CameraColumns> byReference;
    const auto add = [&](const auto& pairs, size_t offset)
    {
        for (size_t i = 0; i < pairs.size(); ++i)
        {
            const NormalEquations::CameraColumns columns = equations_.cameraColumns(offset + i);
            all += columns;
            byReference[pairs[i].reference] += columns;
        }
    };
    add(problem_.points, 0);
    add(problem_.planes, problem_.points.size());

    out.sensitivity.camera = -H_inverse_ * all.H;
    out.camera = all.own;  // at the solution, the gradient of the motion is zero
    out.camera.information += all.H.transpose() * out.sensitivity.camera;
    for (const auto& [reference, columns] : byReference)
    {
        const CameraInformation alone = withoutMotion(reference, columns);
        const auto numReferences = static_cast<double>(byReference.size());
        out.cameraByReference.information += alone.information / numReferences;
        out.cameraByReference.gradient += alone.gradient / numReferences;
    }
}

/** What one reference says of the camera, with a motion of its own. */
CameraInformation SolutionAnalysis::withoutMotion(
    int reference, const NormalEquations::CameraColumns& columns) const
{
    Matrix6d H = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    for (const Groups* groups : {&pointGroups_, &planeGroups_})
    {
        if (const auto group = groups->find(reference); group != groups->end())
        {
            H += group->second.H.topLeftCorner<6, 6>();
            gradient += group->second.g.head<6>();
        }
    }
    // Of some directions, a reference may tell nothing.
    const Eigen::Matrix<double, 6, kNumCameraErrors> ofCamera = columns.H.topRows<6>();
    const Eigen::Matrix<double, 6, kNumCameraErrors> follows =
        H.completeOrthogonalDecomposition().solve(ofCamera);
    CameraInformation out = columns.own;
    out.information -= ofCamera.transpose() * follows;
    out.gradient -= follows.transpose() * gradient;
    return out;
}

double SolutionAnalysis::pointSupport() const
{
    const Matrix6d byPoints = equations_.points().H.topLeftCorner<6, 6>();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> shares(
        byPoints, Matrix6d(H_.topLeftCorner<6, 6>()));
    double out = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 6; ++k)
    {
        if (shares.eigenvalues()[k] > 0.5)
        {
            Vector12d direction = Vector12d::Zero();
            direction.head<6>() = shares.eigenvectors().col(k);
            out = std::min(out, effectivePoints(direction));
        }
    }
    return out;
}

/** Points that know a direction, each by what it knows: (sum h)^2 / sum h^2 (Kish 1965). */
double SolutionAnalysis::effectivePoints(const Vector12d& direction) const
{
    const auto order = sortedByFeature(problem_.points);
    double sum = 0, sumOfSquares = 0;
    for (auto it = order.begin(); it != order.end();)
    {
        const int feature = it->first;
        double h = 0;
        for (; it != order.end() && it->first == feature; ++it)
        {
            h += direction.dot(
                equations_.influence(it->second) * equations_.jacobian(it->second) * direction);
        }
        sum += h;
        sumOfSquares += h * h;
    }
    return sumOfSquares > 0 ? sum * sum / sumOfSquares : 0;
}

double SolutionAnalysis::scatter(const Sensitivity& of) const
{
    std::map<std::pair<int, int>, Vector12d> cells;
    std::map<int, Vector12d> planes;
    const auto add = [&](auto& parts, const auto& part, size_t i)
    {
        parts.emplace(part, Vector12d::Zero()).first->second +=
            equations_.influence(i) * equations_.residual(i).r;
    };
    for (size_t i = 0; i < problem_.points.size(); ++i)
    {
        add(cells, viewCell(problem_.points[i].cur.mean, kCell), i);
    }
    for (const auto& [plane, i] : sortedByFeature(problem_.planes))
    {
        add(planes, plane, problem_.points.size() + i);
    }
    Matrix12d scores = Matrix12d::Zero();
    const auto addSquares = [&](const auto& parts)
    {
        for (const auto& [part, score] : parts)
        {
            scores += score * score.transpose();
        }
    };
    addSquares(cells);
    addSquares(planes);
    const Matrix6d pulls = propagate(H_inverse_, scores).topLeftCorner<6, 6>();
    // Few features move the solution in some directions only.
    const Eigen::CompleteOrthogonalDecomposition<Matrix6d> noise(
        Matrix6d((of.points + of.planes).topLeftCorner<6, 6>()));
    // The solution brings as many parts to agree as it has directions, right or wrong.
    const bool tells = cells.size() + planes.size() > 6 && noise.rank() > 0;
    return tells ? noise.solve(pulls).trace() / static_cast<double>(noise.rank()) : 0;
}

/** Poses follow planes by as many dimensions as planes tell of them: that of the frame does, and
 * those of the references did. Residuals have so many fewer. */
PlaneResiduals SolutionAnalysis::planeResiduals() const
{
    PlaneResiduals out;
    const Matrix6d byPlanes = equations_.planes().H.topLeftCorner<6, 6>();
    const Matrix6d byPoints = equations_.points().H.topLeftCorner<6, 6>();
    const Matrix6d H = byPlanes + byPoints;
    const double dimensions = H.completeOrthogonalDecomposition().solve(byPlanes).trace();
    if (!byPoints.isZero(0))
    {
        // What nothing tells (H is singular there) must not count as told by points.
        const Matrix6d told = H + 1e-14 * H.trace() * Matrix6d::Identity();
        const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> parts(
            byPoints, told, Eigen::EigenvaluesOnly | Eigen::Ax_lBx);
        out.followed = std::clamp(1 - parts.eigenvalues().maxCoeff(), 0.0, 1.0);
    }
    std::map<int, std::vector<double>> norms;
    for (size_t i = 0; i < problem_.planes.size(); ++i)
    {
        norms[problem_.planes[i].reference].push_back(
            equations_.relativeNorm(problem_.points.size() + i));
    }
    for (auto& [reference, ofPlanes] : norms)
    {
        const double all = 3 * static_cast<double>(ofPlanes.size()), dof = all - dimensions;
        if (dof >= kLeastLeft * all)
        {
            out.references.push_back({reference, medianVariance(ofPlanes) * all / dof, dof});
        }
    }
    return out;
}

std::vector<double> SolutionAnalysis::pointWeights() const
{
    return weights(0, problem_.points.size());
}

std::vector<double> SolutionAnalysis::planeWeights() const
{
    return weights(problem_.points.size(), problem_.points.size() + problem_.planes.size());
}

std::vector<double> SolutionAnalysis::weights(size_t begin, size_t end) const
{
    std::vector<double> out;
    for (size_t i = begin; i < end; ++i)
    {
        out.push_back(equations_.ofSurface(i) * equations_.weight(i));
    }
    return out;
}
}  // namespace pointplane
