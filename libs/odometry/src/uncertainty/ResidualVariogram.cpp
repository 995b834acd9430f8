// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/NoiseScale.h>
#include <pointplane/odometry/uncertainty/ResidualVariogram.h>
#include <pointplane/pose/median_variance.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace pointplane
{
namespace
{
/** A feature that the estimate follows shows nothing of its own noise. */
constexpr double kLeastOwnShare = 0.2;

/** Before anything is known, each level is this part of the residuals' variance; as if so many
 * views had said so. */
constexpr double kFirstPart = 0.3, kFirstViews = 0.3;

/** Levels are small differences at times: not below this part of the residuals' variance. */
constexpr double kLeastPart = 0.05;

}  // namespace

void ResidualVariogram::update(
    const PoseAnalysis& analysis,
    const Eigen::Matrix3d& R_world_prev,
    double views,
    double dt,
    const NoiseFactors& residuals)
{
    steps_.push_front({views, dt});
    const auto tooOld = [&, age = 0.0](const Step& step) mutable
    { return (age += step.dt) > timeConstant_; };
    steps_.erase(std::find_if(steps_.begin() + 1, steps_.end(), tooOld), steps_.end());
    const double kept = std::exp(-dt / timeConstant_);
    Snapshot points = snapshot(analysis.pointResiduals, R_world_prev, points_.white);
    Snapshot planes = snapshot(analysis.planeResiduals, R_world_prev, planes_.white);
    update(points_, std::move(points), kept, residuals.points);
    update(planes_, std::move(planes), kept, residuals.planes);
}

ResidualVariogram::Snapshot ResidualVariogram::snapshot(
    const std::vector<FeatureResidual>& residuals,
    const Eigen::Matrix3d& R_world_prev,
    double ownWhite) const
{
    Snapshot out;
    out.reserve(residuals.size());
    for (const FeatureResidual& f : residuals)
    {
        const double ofOthers = points_.white * f.ofPoints + planes_.white * f.ofPlanes;
        out.push_back(
            {{f.reference, f.inReference},
             R_world_prev * f.r,
             R_world_prev * f.curCov * R_world_prev.transpose(),
             f.own + ofOthers / ownWhite});
    }
    std::sort(out.begin(), out.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
    return out;
}

/** Half of the squared difference, over the propagated variance: from the median, as there are
 * wrong matches. */
std::optional<double> ResidualVariogram::variogram(const Snapshot& now, const Snapshot& then)
{
    std::vector<double> squared;
    squared.reserve(now.size());
    auto old = then.begin();
    for (const Entry& entry : now)
    {
        while (old != then.end() && old->key < entry.key)
        {
            ++old;
        }
        if (old == then.end() || entry.key < old->key)
        {
            continue;
        }
        const double share = (entry.share + old->share) / 2;
        const Eigen::Vector3d d = entry.r - old->r;
        const Eigen::Matrix3d cov = share * (entry.cov + old->cov);
        const double norm2 = d.dot(cov.inverse() * d);
        if (share >= kLeastOwnShare && std::isfinite(norm2))
        {
            squared.push_back(norm2 / medianChi2(3));
        }
    }
    if (squared.empty())
    {
        return {};
    }
    return NoiseScale::plausible(medianVariance(squared));
}

bool ResidualVariogram::shareReference(const Snapshot& now, const Snapshot& then)
{
    return std::any_of(
        now.begin(),
        now.end(),
        [&](const Entry& entry)
        {
            const auto it = std::lower_bound(
                then.begin(),
                then.end(),
                entry.key.first,
                [](const Entry& e, int reference) { return e.key.first < reference; });
            return it != then.end() && it->key.first == entry.key.first;
        });
}

void ResidualVariogram::update(Kind& kind, Snapshot now, double kept, double residuals) const
{
    kind.past.resize(std::min(kind.past.size(), steps_.size()));
    size_t lag = kind.past.size();
    const auto wayTo = [&](size_t n)
    {
        return std::accumulate(
            steps_.begin() + 1,
            steps_.begin() + static_cast<std::ptrdiff_t>(n),
            0.0,
            [](double way, const Step& step) { return way + step.views; });
    };
    // Farther apart than a view, errors have nothing in common, and do not grow with the way.
    while (lag > 2 && wayTo(lag) > 1)
    {
        --lag;
    }
    auto step = lag > 0 ? variogram(now, kind.past.front()) : std::optional<double>();
    if (lag > 0 && !now.empty() && !shareReference(now, kind.past.front()))
    {
        step = residuals;  // of references that are new, residuals are what has changed since
    }
    if (step)
    {
        kind.weight = kept * kind.weight + 1;
        kind.step = kept * kind.step + *step;
        kind.views = kept * kind.views + steps_.front().views;
        const auto far = lag >= 2 ? variogram(now, kind.past[lag - 1]) : std::optional<double>();
        if (far)
        {
            // The slope by least squares: frames at rest say nothing of it.
            const double way = wayTo(lag);
            kind.growth = kept * kind.growth + way * (*far - *step);
            kind.farther = kept * kind.farther + way * way;
        }
    }
    kind.drift = std::max(
        kLeastPart * residuals,
        (kind.growth + kFirstPart * residuals * kFirstViews * kFirstViews) /
            (kind.farther + kFirstViews * kFirstViews));
    kind.white = std::max(
        kLeastPart * residuals,
        (kind.step - kind.drift * kind.views + kFirstPart * residuals * NoiseScale::kFirstFrames) /
            (kind.weight + NoiseScale::kFirstFrames));
    kind.past.push_front(std::move(now));
}
}  // namespace pointplane
