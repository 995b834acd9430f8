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
/** Residuals are compared with those of the frame before and of so many frames before. Within a
 * view: farther apart, errors have nothing in common any more, and do not grow with the way. */
constexpr size_t kLag = 10;

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
    views_.push_front(views);
    const double kept = std::exp(-dt / timeConstant_);
    Snapshot points = snapshot(analysis.pointResiduals, R_world_prev, points_.white);
    Snapshot planes = snapshot(analysis.planeResiduals, R_world_prev, planes_.white);
    update(points_, std::move(points), kept, residuals.points);
    update(planes_, std::move(planes), kept, residuals.planes);
    views_.resize(std::min(views_.size(), kLag));
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
    size_t lag = std::min(kind.past.size(), kLag);
    const auto wayTo = [&](size_t n)
    {
        return std::accumulate(
            views_.begin() + 1, views_.begin() + static_cast<std::ptrdiff_t>(n), 0.0);
    };
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
        kind.views = kept * kind.views + views_.front();
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
    if (kind.past.size() > kLag)
    {
        kind.past.pop_back();
    }
}
}  // namespace pointplane
