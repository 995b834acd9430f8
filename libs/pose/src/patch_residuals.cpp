// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "SolutionAnalysis.h"

namespace pointplane
{
namespace
{
using ByScales = Eigen::Matrix<double, 1, kNumPatches>;

/** What the points of a patch say of its scale of depth, over that of the reference. */
struct Patch
{
    int numPoints{0};
    double weight{0}, mean{0};
    double squares{0};  //!< weighted, of the deviations from the mean
    /** How the mean follows the scales of all patches of the frame: the pose goes with them. */
    ByScales byScales{ByScales::Zero()};

    void add(double scale, double variance, double robustWeight, const ByScales& follows)
    {
        const double w = robustWeight / variance, share = w / (weight + w);
        ++numPoints;
        weight += w;
        squares += w * (1 - share) * std::pow(scale - mean, 2);
        mean += share * (scale - mean);
        byScales += share * (follows - byScales);
    }
};
using Patches = std::array<Patch, kNumPatches>;

/** \param i of a pair of points with depth */
void addPair(const Solution& at, const Sensitivity& of, size_t i, Patches& patches)
{
    const PointPair& pair = at.problem.points[i];
    const Residual& residual = at.equations.residual(i);
    const double robustWeight = at.equations.weight(i);
    if (!(robustWeight > 0))
    {
        return;
    }
    const Eigen::Vector3d ray = pair.dRef_dCamera.col(kDepthScale);
    const Eigen::RowVector3d along = ray.transpose() / ray.squaredNorm();
    ByScales follows = along * at.equations.jacobian(i) * of.patches;
    follows[pair.curPatch] += along * (residual.ofCamera.col(kDepthScale) - ray);
    patches[static_cast<size_t>(pair.curPatch)].add(
        along * residual.r, along * residual.cov * along.transpose(), robustWeight, follows);
}

/** Variance of a point's noise, over the propagated one, as points of the same patches show it. */
double noiseWithin(const Patches& patches)
{
    double squares = 0, dof = 0;
    for (const Patch& patch : patches)
    {
        squares += patch.squares;
        dof += std::max(0, patch.numPoints - 1);
    }
    return dof > 0 ? squares / dof : 0;
}

/** With patches of the frame and of the reference that err alike, the mean of a patch has the
 * variance 2 v |byScales|^2 + noise / weight. \return v; less than zero by chance */
ReferenceVariance varianceOf(const Patches& patches, int reference)
{
    const double noise = noiseWithin(patches);
    double observed = 0, expected = 0;
    ReferenceVariance out{reference, 0, 0};
    for (const Patch& patch : patches)
    {
        if (patch.numPoints > 1)
        {
            observed += patch.mean * patch.mean - noise / patch.weight;
            expected += 2 * patch.byScales.squaredNorm();
            ++out.dof;
        }
    }
    if (expected > 0)
    {
        out.variance = observed / expected;
    }
    return out;
}
}  // namespace

std::vector<ReferenceVariance> residualsOfPatches(const Solution& at, const Sensitivity& of)
{
    std::map<int, Patches> references;
    for (size_t i = 0; i < at.problem.points.size(); ++i)
    {
        const PointPair& pair = at.problem.points[i];
        if (pair.hasDepth && pair.refPatch >= 0 && pair.curPatch >= 0)
        {
            addPair(at, of, i, references[pair.reference]);
        }
    }
    std::vector<ReferenceVariance> out;
    for (const auto& [reference, patches] : references)
    {
        if (const ReferenceVariance v = varianceOf(patches, reference); v.dof > 0)
        {
            out.push_back(v);
        }
    }
    return out;
}
}  // namespace pointplane
