// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/stamp_intervals.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pointplane
{
namespace
{
constexpr double kSameTime = 1e-6;  // [s] to which files are rounded

Eigen::Isometry3d interpolated(
    const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double fraction)
{
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.translation() = (1 - fraction) * a.translation() + fraction * b.translation();
    out.linear() = Eigen::Quaterniond(a.linear())
                       .slerp(fraction, Eigen::Quaterniond(b.linear()))
                       .toRotationMatrix();
    return out;
}

struct Candidate
{
    double difference;  //!< of the stamps [s]
    std::size_t first, second;

    [[nodiscard]] bool operator<(const Candidate& other) const
    {
        return std::tie(difference, first, second) <
               std::tie(other.difference, other.first, other.second);
    }
};

/** All pairs of stamps that are near enough, the nearest first. */
std::vector<Candidate> candidatesOf(
    const std::vector<double>& first,
    const std::vector<double>& second,
    double offset,
    double maxDifference)
{
    std::vector<Candidate> out;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < first.size(); ++i)
    {
        while (begin < second.size() && second[begin] + offset <= first[i] - maxDifference)
        {
            ++begin;
        }
        // One step further to each side: the comparison that counts is the script's own, below.
        for (std::size_t j = begin > 0 ? begin - 1 : 0; j < second.size(); ++j)
        {
            const double difference = std::abs(first[i] - (second[j] + offset));
            if (difference < maxDifference)
            {
                out.push_back({difference, i, j});
            }
            else if (second[j] + offset > first[i] + maxDifference)
            {
                break;
            }
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

/** Puts the truth at a stamp in the place of the nearest one, if it is known before and after.
 * \param i of the stamp in `out` */
void interpolate(
    const Trajectory& groundTruth,
    const std::vector<bool>& holes,
    double stamp,
    std::size_t i,
    SampledTruth& out)
{
    const std::vector<double>& truth = groundTruth.stamps;
    const auto after = std::upper_bound(truth.begin(), truth.end(), stamp);
    if (after == truth.begin() || after == truth.end())
    {
        out.valid[i] = 0;
        return;
    }
    const auto k = static_cast<std::size_t>(after - truth.begin());
    if (holes[k])
    {
        out.valid[i] = std::abs(out.stamps[i] - stamp) <= kSameTime ? 1 : 0;
        return;
    }
    out.stamps[i] = stamp;
    out.isOfOtherTime[i] = 0;
    out.poses[i] = interpolated(
        groundTruth.poses[k - 1],
        groundTruth.poses[k],
        (stamp - truth[k - 1]) / (truth[k] - truth[k - 1]));
}
}  // namespace

std::size_t nearestIndex(const std::vector<double>& sorted, double value)
{
    POINTPLANE_CHECK(!sorted.empty(), "nearestIndex of an empty list");
    value = std::clamp(value, sorted.front(), sorted.back());  // differences to 1e300 are all alike
    std::size_t best = 0;
    double difference = std::abs(sorted[0] - value);
    std::size_t begin = 0;
    std::size_t end = sorted.size();
    while (begin < end)
    {
        const std::size_t middle = (begin + end) / 2;
        if (std::abs(sorted[middle] - value) < difference)
        {
            difference = std::abs(sorted[middle] - value);
            best = middle;
        }
        if (sorted[middle] == value)
        {
            return middle;
        }
        if (sorted[middle] > value)
        {
            end = middle;
        }
        else
        {
            begin = middle + 1;
        }
    }
    return best;
}

std::vector<std::pair<std::size_t, std::size_t>> associate(
    const std::vector<double>& first,
    const std::vector<double>& second,
    double offset,
    double maxDifference)
{
    std::vector<char> firstUsed(first.size(), 0);
    std::vector<char> secondUsed(second.size(), 0);
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (const auto& [difference, i, j] : candidatesOf(first, second, offset, maxDifference))
    {
        if (firstUsed[i] == 0 && secondUsed[j] == 0)
        {
            firstUsed[i] = secondUsed[j] = 1;
            pairs.emplace_back(i, j);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

SampledTruth sampleTruth(
    const Trajectory& groundTruth, const std::vector<double>& stamps, double offset, TruthAt at)
{
    SampledTruth out;
    out.poses.assign(stamps.size(), Eigen::Isometry3d::Identity());
    out.valid.assign(stamps.size(), 0);
    out.isOfOtherTime.assign(stamps.size(), 0);
    out.stamps.assign(stamps.size(), 0);
    out.maxTimeDifference = 2 * medianInterval(groundTruth.stamps);
    const std::vector<double>& truth = groundTruth.stamps;
    const std::vector<bool> holes = holesBefore(groundTruth);
    for (std::size_t i = 0; i < stamps.size(); ++i)
    {
        const double stamp = stamps[i] + offset;
        const std::size_t nearest = nearestIndex(truth, stamp);
        out.stamps[i] = truth[nearest];
        out.poses[i] = groundTruth.poses[nearest];
        out.valid[i] = std::abs(truth[nearest] - stamp) <= out.maxTimeDifference ? 1 : 0;
        out.isOfOtherTime[i] =
            std::abs(truth[nearest] - stamp) > 0.5 * out.maxTimeDifference - kSameTime ? 1 : 0;
        if (at != TruthAt::NearestStamp && out.valid[i] != 0 && truth[nearest] != stamp)
        {
            interpolate(groundTruth, holes, stamp, i, out);
        }
    }
    return out;
}
}  // namespace pointplane
