// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/simulation/Renderer.h>
#include <pointplane/simulation/RowCaster.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr int kSamples = 4;
/** Rotated grid: no two samples share a row or column. */
constexpr std::array<std::array<double, 2>, kSamples> kOffsets{
    {{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}}};

/** Surfaces seen in the 3 x 3 neighbourhood of a pixel. */
struct Candidates
{
    std::array<std::int32_t, 9> ids{};
    int count{0};

    Candidates(const cv::Mat& image, int u, int v)
    {
        for (int y = std::max(0, v - 1); y <= std::min(image.rows - 1, v + 1); ++y)
        {
            for (int x = std::max(0, u - 1); x <= std::min(image.cols - 1, u + 1); ++x)
            {
                const std::int32_t id = image.ptr<std::int32_t>(y)[x];
                if (id >= 0 &&
                    std::find(ids.begin(), ids.begin() + count, id) == ids.begin() + count)
                {
                    ids[static_cast<std::size_t>(count++)] = id;
                }
            }
        }
    }
};

bool isEdge(
    const std::int32_t* above, const std::int32_t* row, const std::int32_t* below, int u, int last)
{
    const std::int32_t id = row[u];
    return above[u] != id || below[u] != id || row[std::max(u - 1, 0)] != id ||
           row[std::min(u + 1, last)] != id;
}

cv::Vec3i sampleColour(const RowCaster& caster, const Candidates& candidates, double u)
{
    double nearest = 0;
    std::int32_t hit = -1;
    for (int c = 0; c < candidates.count; ++c)
    {
        const std::int32_t id = candidates.ids[static_cast<std::size_t>(c)];
        const double q = caster.inverseDepthAt(u, id);
        if (q > nearest)
        {
            nearest = q;
            hit = id;
        }
    }
    return hit < 0 ? cv::Vec3i(0, 0, 0) : cv::Vec3i(caster.colourAt(u, hit, nearest));
}

void smoothEdges(RowCaster& caster, const RowPose& pose, const cv::Mat& ids, int v, cv::Mat& bgr)
{
    const auto* row = ids.ptr<std::int32_t>(v);
    const auto* above = ids.ptr<std::int32_t>(std::max(v - 1, 0));
    const auto* below = ids.ptr<std::int32_t>(std::min(v + 1, ids.rows - 1));
    std::vector<int> edges;
    std::vector<Candidates> candidates;
    for (int u = 0; u < ids.cols; ++u)
    {
        if (isEdge(above, row, below, u, ids.cols - 1))
        {
            edges.push_back(u);
            candidates.emplace_back(ids, u, v);
        }
    }
    std::vector<cv::Vec3i> sums(edges.size(), cv::Vec3i(0, 0, 0));
    for (std::size_t s = 0; s < kSamples && !edges.empty(); ++s)
    {
        caster.setRow(pose.T_world_cam, v + kOffsets[s][1], pose.t);
        for (std::size_t k = 0; k < edges.size(); ++k)
        {
            sums[k] += sampleColour(caster, candidates[k], edges[k] + kOffsets[s][0]);
        }
    }
    for (std::size_t k = 0; k < edges.size(); ++k)
    {
        bgr.at<cv::Vec3b>(v, edges[k]) = (sums[k] + cv::Vec3i::all(kSamples / 2)) / kSamples;
    }
}

void checkPoses(const PinholeCamera& camera, const RowPoses& poses)
{
    POINTPLANE_CHECK(!camera.isDistorted(), "lens distortion is not simulated");
    POINTPLANE_CHECK(
        static_cast<int>(poses.size()) == camera.height,
        poses.size() << " poses for " << camera.height << " rows");
}
}  // namespace

CastImage castImage(const Scene& scene, const PinholeCamera& camera, const RowPoses& poses)
{
    checkPoses(camera, poses);
    CastImage out{
        cv::Mat(camera.height, camera.width, CV_32FC1),
        cv::Mat(camera.height, camera.width, CV_32SC1)};
    RowCaster caster(scene, camera);
    for (int v = 0; v < camera.height; ++v)
    {
        const RowPose& pose = poses[static_cast<std::size_t>(v)];
        caster.setRow(pose.T_world_cam, v, pose.t);
        caster.cast(out.inverseDepth.ptr<float>(v), out.ids.ptr<std::int32_t>(v));
    }
    return out;
}

cv::Mat shadeImage(
    const Scene& scene,
    const PinholeCamera& camera,
    const RowPoses& poses,
    const CastImage& cast,
    bool antialias)
{
    checkPoses(camera, poses);
    cv::Mat bgr(camera.height, camera.width, CV_8UC3);
    RowCaster caster(scene, camera);
    for (int v = 0; v < camera.height; ++v)
    {
        const RowPose& pose = poses[static_cast<std::size_t>(v)];
        caster.setRow(pose.T_world_cam, v, pose.t);
        caster.shade(
            cast.inverseDepth.ptr<float>(v), cast.ids.ptr<std::int32_t>(v), bgr.ptr<cv::Vec3b>(v));
        if (antialias)
        {
            smoothEdges(caster, pose, cast.ids, v, bgr);
        }
    }
    return bgr;
}
}  // namespace pointplane
