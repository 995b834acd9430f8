// SPDX-License-Identifier: BSD-3-Clause
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
/** Residuals are compared with those of the frame before and of so many frames before. */
constexpr size_t kLag = 10;
constexpr size_t kLeastLag = 2;

/** Farther apart in views, errors have nothing in common any more: they do not grow with the way.
 */
constexpr double kMostViews = 1.5;

constexpr double kTimeConstant = 2;  // [s] of both levels

/** A frame with fewer features in common says nothing: their median is chance. */
constexpr size_t kLeastPoints = 6, kLeastPlanes = 2;

/** A feature that the estimate follows shows nothing of its own noise. */
constexpr double kLeastShare = 0.2;

/** Before anything is known: parts of the residuals' variance, as if two frames and 0.3 views had
 * said so; by hand. */
constexpr double kFirstStep = 0.3, kFirstWhite = 0.2, kFirstDrift = 0.4;
constexpr double kFirstFrames = 2, kFirstViews = 0.3;

/** Levels are small differences at times: not below a part of what they are differences of. */
constexpr double kLeastWhite = 0.1, kLeastDrift = 0.05;

/** A few odd frames must neither make features certain nor worthless. */
constexpr double kMinVariogram = 0.003, kMaxVariogram = 1000;

}  // namespace

void ResidualVariogram::update(
    const PoseAnalysis& analysis,
    const Eigen::Matrix3d& R_world_prev,
    double views,
    double dt,
    const NoiseFactors& residuals)
{
    views_.push_front(views);
    const double kept = std::exp(-dt / kTimeConstant);
    Snapshot points = snapshot(analysis.pointResiduals, R_world_prev, points_.white);
    Snapshot planes = snapshot(analysis.planeResiduals, R_world_prev, planes_.white);
    update(points_, std::move(points), kLeastPoints, kept, residuals.points);
    update(planes_, std::move(planes), kLeastPlanes, kept, residuals.planes);
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
std::optional<double> ResidualVariogram::variogram(
    const Snapshot& now, const Snapshot& then, size_t least)
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
        if (share >= kLeastShare && std::isfinite(norm2))
        {
            squared.push_back(norm2);
        }
    }
    if (squared.size() < least)
    {
        return {};
    }
    return std::clamp(medianVariance(squared), kMinVariogram, kMaxVariogram);
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

void ResidualVariogram::update(
    Kind& kind, Snapshot now, size_t least, double kept, double residuals) const
{
    size_t lag = std::min(kind.past.size(), kLag);
    const auto wayTo = [&](size_t n)
    {
        return std::accumulate(
            views_.begin() + 1, views_.begin() + static_cast<std::ptrdiff_t>(n), 0.0);
    };
    while (lag > kLeastLag && wayTo(lag) > kMostViews)
    {
        --lag;
    }
    auto step = lag > 0 ? variogram(now, kind.past.front(), least) : std::optional<double>();
    if (lag > 0 && now.size() >= least && !shareReference(now, kind.past.front()))
    {
        step = residuals;  // of references that are new, residuals are what has changed since
    }
    if (step)
    {
        kind.weight = kept * kind.weight + 1;
        kind.step = kept * kind.step + *step;
        kind.views = kept * kind.views + views_.front();
        const auto far =
            lag >= kLeastLag ? variogram(now, kind.past[lag - 1], least) : std::optional<double>();
        if (far)
        {
            // The slope by least squares: frames at rest say nothing of it.
            const double way = wayTo(lag);
            kind.growth = kept * kind.growth + way * (*far - *step);
            kind.farther = kept * kind.farther + way * way;
        }
    }
    kind.drift = std::max(
        kLeastDrift * residuals,
        (kind.growth + kFirstDrift * residuals * kFirstViews * kFirstViews) /
            (kind.farther + kFirstViews * kFirstViews));
    const double frames = kind.weight + kFirstFrames;
    const double first = kFirstFrames * residuals;
    kind.white = std::max(
        kLeastWhite * (kind.step + kFirstStep * first) / frames,
        (kind.step - kind.drift * kind.views + kFirstWhite * first) / frames);
    kind.past.push_front(std::move(now));
    if (kind.past.size() > kLag)
    {
        kind.past.pop_back();
    }
}
}  // namespace pointplane
