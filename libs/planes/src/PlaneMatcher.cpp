// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/range.h>
#include <pointplane/planes/PlaneMatcher.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr int kStridePx = 8;  //!< segments that move are compared on a grid of this pitch

constexpr double kStill = 1e-9;  //!< rounding errors of a motion that is none

/** Samples common to each pair of segments, and of each segment alone. */
struct OverlapCounts
{
    OverlapCounts(size_t numRef, size_t numCur)
        : ref(numRef, 0), cur(numCur, 0), common(numRef, std::vector<int>(numCur, 0))
    {
    }
    std::vector<int> ref, cur;
    std::vector<std::vector<int>> common;
};

/** The segments as they lie on each other, pixel by pixel [P17, section Matching]. */
OverlapCounts countOverlaps(const PlaneSet& ref, const PlaneSet& cur)
{
    OverlapCounts counts(ref.planes.size(), cur.planes.size());
    for (int v = 0; v < ref.labels.rows; ++v)
    {
        const auto* refRow = ref.labels.ptr<uchar>(v);
        const auto* curRow = cur.labels.ptr<uchar>(v);
        for (int u = 0; u < ref.labels.cols; ++u)
        {
            const int r = refRow[u] - 1, c = curRow[u] - 1;
            if (r >= 0)
            {
                ++counts.ref[static_cast<size_t>(r)];
            }
            if (c >= 0)
            {
                ++counts.cur[static_cast<size_t>(c)];
            }
            if (r >= 0 && c >= 0)
            {
                ++counts.common[static_cast<size_t>(r)][static_cast<size_t>(c)];
            }
        }
    }
    return counts;
}

/** Moves the reference's segments by the predicted motion, each along its own plane, and counts
 * where they fall on the current ones. */
OverlapCounts countOverlaps(
    const PlaneSet& ref,
    const PlaneSet& cur,
    const PinholeCamera& camera,
    const Eigen::Isometry3d& T_cur_ref)
{
    OverlapCounts counts(ref.planes.size(), cur.planes.size());
    for (int v = kStridePx / 2; v < ref.labels.rows; v += kStridePx)
    {
        for (int u = kStridePx / 2; u < ref.labels.cols; u += kStridePx)
        {
            const int c = cur.labels.at<uchar>(v, u) - 1;
            if (c >= 0)
            {
                ++counts.cur[static_cast<size_t>(c)];
            }
            const int r = ref.labels.at<uchar>(v, u) - 1;
            if (r < 0)
            {
                continue;
            }
            ++counts.ref[static_cast<size_t>(r)];
            const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
            const double q = -ref.planes[static_cast<size_t>(r)].plane_cam.theta_m.dot(ray);
            const Eigen::Vector3d p_cur = T_cur_ref * Eigen::Vector3d(ray / q);
            if (!(q > 0) || !(p_cur.z() > 0))
            {
                continue;
            }
            const double uCur = camera.fx * p_cur.x() / p_cur.z() + camera.cx + 0.5;
            const double vCur = camera.fy * p_cur.y() / p_cur.z() + camera.cy + 0.5;
            if (uCur >= 0 && vCur >= 0 && uCur < cur.labels.cols && vCur < cur.labels.rows)
            {
                const int hit =
                    cur.labels.at<uchar>(static_cast<int>(vCur), static_cast<int>(uCur)) - 1;
                if (hit >= 0)
                {
                    ++counts.common[static_cast<size_t>(r)][static_cast<size_t>(hit)];
                }
            }
        }
    }
    return counts;
}

struct Candidate
{
    double distance;
    PlaneMatch match;
};

/** Pairs that pass the tests of overlap, angle and distance, the nearest first. */
std::vector<Candidate> candidatesOf(
    const PlaneSet& ref,
    const PlaneSet& cur,
    const OverlapCounts& counts,
    const Eigen::Isometry3d& T_cur_ref,
    const PlaneMatcher::TParams& params)
{
    const double minCosine = std::cos(params.maxNormalAngleDeg * M_PI / 180);
    std::vector<Candidate> candidates;
    for (size_t r = 0; r < ref.planes.size(); ++r)
    {
        const Plane moved = transformed(T_cur_ref, hessianForm(ref.planes[r].plane_cam.theta_m));
        for (size_t c = 0; c < cur.planes.size(); ++c)
        {
            const Plane plane = hessianForm(cur.planes[c].plane_cam.theta_m);
            const int smaller = std::min(counts.ref[r], counts.cur[c]);
            // [P17, section Matching]: overlap, angle, distance.
            if (counts.common[r][c] >= params.minOverlap * std::max(1, smaller) &&
                moved.n.dot(plane.n) > minCosine &&
                std::abs(moved.d - plane.d) < params.maxDistance)
            {
                candidates.push_back(
                    {(moved.d * moved.n - plane.d * plane.n).norm(),  // [P17 Eq. 7]
                     {static_cast<int>(r), static_cast<int>(c)}});
            }
        }
    }
    std::stable_sort(
        candidates.begin(),
        candidates.end(),
        [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
    return candidates;
}
}  // namespace

void PlaneMatcher::TParams::check() const
{
    checkRange("minOverlap", minOverlap, 0.01, 1);
    checkRange("maxNormalAngleDeg", maxNormalAngleDeg, 0.1, 90);
    checkLength("maxDistance", maxDistance, 1e-4, 2);
}

PlaneMatcher::PlaneMatcher(const TParams& params) : params_(params) { params_.check(); }

std::vector<PlaneMatch> PlaneMatcher::match(
    const PlaneSet& ref,
    const PlaneSet& cur,
    const PinholeCamera& camera,
    const Eigen::Isometry3d& T_cur_ref) const
{
    if (ref.planes.empty() || cur.planes.empty() || ref.labels.size() != cur.labels.size())
    {
        return {};
    }
    const OverlapCounts counts = T_cur_ref.matrix().isIdentity(kStill)
                                     ? countOverlaps(ref, cur)
                                     : countOverlaps(ref, cur, camera, T_cur_ref);
    std::vector<bool> refTaken(ref.planes.size()), curTaken(cur.planes.size());
    std::vector<PlaneMatch> matches;
    for (const Candidate& candidate : candidatesOf(ref, cur, counts, T_cur_ref, params_))
    {
        const auto r = static_cast<size_t>(candidate.match.ref);
        const auto c = static_cast<size_t>(candidate.match.cur);
        const bool isFree = !refTaken[r] && !curTaken[c];
        if (isFree)
        {
            matches.push_back(candidate.match);
            curTaken[c] = true;
        }
        // [P17, section Matching]: the candidate at the least distance is selected, no other.
        refTaken[r] = refTaken[r] || isFree || !params_.secondNearest;
    }
    std::sort(
        matches.begin(),
        matches.end(),
        [](const PlaneMatch& a, const PlaneMatch& b) { return a.ref < b.ref; });
    return matches;
}
}  // namespace pointplane
