// SPDX-License-Identifier: BSD-3-Clause
#include "ImageAligner.h"

#include <pointplane/core/se3.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <random>

#include "by_chance.h"
#include "surface_comparison.h"

namespace pointplane
{
namespace
{
/** So many points tell a motion. */
constexpr size_t kSample = 3;

/** Motions of three points that are tried: with a fifth of the pairs right, 98 of 100 times one is.
 */
constexpr int kMaxTrials = 500;

/** How far a point may be from where a motion puts it, as a part of the image's width. */
constexpr double kPixelFraction = 0.006;

PointDetector::TParams detectorParams()
{
    PointDetector::TParams out;
    out.detector = "orb";
    out.upright = false;
    return out;
}

PointMatcher::TParams matcherParams()
{
    PointMatcher::TParams out;
    out.searchRadiusPx = 20000;  // the whole image
    return out;
}

/** Whether pairs agree with a motion. */
class ReprojectionTest
{
 public:
    ReprojectionTest(
        const MatchedPoints& pairs, const PinholeCamera& camera, const DepthNoise& noise)
        : pairs_(pairs), camera_(camera), noise_(noise)
    {
    }

    [[nodiscard]] std::vector<size_t> inliers(const Eigen::Isometry3d& T, double widening) const
    {
        std::vector<size_t> out;
        const double most = widening * kPixelFraction * camera_.width;
        for (size_t i = 0; i < pairs_.ref.size(); ++i)
        {
            const Eigen::Vector3d p = T * pairs_.ref[i];
            if (p.z() <= 0)
            {
                continue;
            }
            const Eigen::Vector3d& q = pairs_.cur[i];
            const double du = camera_.fx * (p.x() / p.z() - q.x() / q.z());
            const double dv = camera_.fy * (p.y() / p.z() - q.y() / q.z());
            const double inverse = std::abs(1 / p.z() - 1 / q.z());
            const double same = M_SQRT2 * widening * noise_.sameDepth(q.z()) / (q.z() * q.z());
            if (du * du + dv * dv < most * most && inverse < same)
            {
                out.push_back(i);
            }
        }
        return out;
    }

    /** Distances between three points do not change. */
    [[nodiscard]] bool isRigid(const size_t (&s)[kSample]) const
    {
        for (int k = 0; k < 3; ++k)
        {
            const size_t a = s[k], b = s[(k + 1) % 3];
            const double before = (pairs_.ref[a] - pairs_.ref[b]).norm();
            const double now = (pairs_.cur[a] - pairs_.cur[b]).norm();
            const double z = std::max(pairs_.cur[a].z(), pairs_.cur[b].z());
            if (std::abs(before - now) > 2 * noise_.sameDepth(z) || before < 0.05 * z)
            {
                return false;
            }
        }
        return true;
    }

    /** By least squares, nearer points counting more. */
    [[nodiscard]] Eigen::Isometry3d fit(const std::vector<size_t>& chosen) const
    {
        Eigen::Vector3d meanRef = Eigen::Vector3d::Zero(), meanCur = Eigen::Vector3d::Zero();
        double sum = 0;
        const auto weight = [&](size_t i)
        {
            const double z = pairs_.cur[i].z();
            return 1 / (z * z * z * z);
        };
        for (const size_t i : chosen)
        {
            const double w = weight(i);
            meanRef += w * pairs_.ref[i];
            meanCur += w * pairs_.cur[i];
            sum += w;
        }
        meanRef /= sum;
        meanCur /= sum;
        Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
        for (const size_t i : chosen)
        {
            S += weight(i) * (pairs_.cur[i] - meanCur) * (pairs_.ref[i] - meanRef).transpose();
        }
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = nearestRotation(S);
        T.translation() = meanCur - T.linear() * meanRef;
        return T;
    }

 private:
    const MatchedPoints& pairs_;
    const PinholeCamera& camera_;
    const DepthNoise& noise_;
};

/** RANSAC: the pairs that agree with the best motion of three of them. */
std::vector<size_t> mostInliers(const ReprojectionTest& test, size_t numPairs)
{
    std::mt19937 random(1);
    std::vector<size_t> best;
    for (int t = 0, tries = 0; t < kMaxTrials && tries < 20 * kMaxTrials; ++tries)
    {
        const size_t s[kSample] = {random() % numPairs, random() % numPairs, random() % numPairs};
        if (s[0] == s[1] || s[1] == s[2] || s[0] == s[2] || !test.isRigid(s))
        {
            continue;
        }
        ++t;
        std::vector<size_t> found = test.inliers(test.fit({s[0], s[1], s[2]}), 2);
        if (found.size() > best.size())
        {
            if (found.size() > kSample)
            {
                auto again = test.inliers(test.fit(found), 2);
                if (again.size() > found.size())
                {
                    found = std::move(again);
                }
            }
            best = std::move(found);
        }
    }
    return best;
}
}  // namespace

ImageAligner::ImageAligner(const PointLifter::TParams& lifter, const DepthNoise& noise)
    : detector_(detectorParams()), matcher_(matcherParams()), lifter_(lifter, noise), noise_(noise)
{
}

MatchedPoints ImageAligner::match(
    const DescribedPoints& reference, const DescribedPoints& current) const
{
    MatchedPoints out;
    if (reference.points.empty() || current.points.empty())
    {
        return out;
    }
    std::vector<Eigen::Vector2d> ref_px, cur_px;
    for (const PointFeature& p : reference.points)
    {
        ref_px.push_back(p.uv_px);
    }
    for (const PointFeature& p : current.points)
    {
        cur_px.push_back(p.uv_px);
    }
    for (const PointMatch& match :
         matcher_.match(ref_px, reference.descriptors, cur_px, current.descriptors))
    {
        out.ref.push_back(reference.points[static_cast<size_t>(match.ref)].p_cam.mean);
        out.cur.push_back(current.points[static_cast<size_t>(match.cur)].p_cam.mean);
    }
    return out;
}

std::optional<Eigen::Isometry3d> ImageAligner::align(
    const MatchedPoints& pairs, const PinholeCamera& camera) const
{
    const size_t n = pairs.ref.size();
    if (n < kFewPoints)
    {
        return {};
    }
    const ReprojectionTest test(pairs, camera, noise_);
    std::vector<size_t> best = mostInliers(test, n);
    if (best.size() < kFewPoints)
    {
        return {};
    }
    Eigen::Isometry3d T = test.fit(best);
    for (int k = 0; k < 3; ++k)
    {
        const std::vector<size_t> found = test.inliers(T, k == 0 ? 2 : 1);
        if (found.size() <= kSample)
        {
            break;
        }
        T = test.fit(found);
        best = found;
    }
    return best.size() < kFewPoints ? std::nullopt : std::optional(T);
}
}  // namespace pointplane
