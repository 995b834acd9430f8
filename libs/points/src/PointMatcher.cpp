// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/range.h>
#include <pointplane/points/PointMatcher.h>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/hal.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace pointplane
{
namespace
{
using Positions = std::vector<Eigen::Vector2d>;

/** Points sorted into square cells over their bounding box. */
class PointGrid
{
 public:
    PointGrid(const Positions& points, double cellPx) : cellPx_(cellPx)
    {
        Eigen::Vector2d low = points[0], high = points[0];
        for (const Eigen::Vector2d& p : points)
        {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        low_ = low;
        cols_ = index(high.x() - low.x()) + 1;
        rows_ = index(high.y() - low.y()) + 1;
        begin_.assign(static_cast<size_t>(cols_ * rows_ + 1), 0);
        for (const Eigen::Vector2d& p : points)
        {
            ++begin_[cell(p) + 1];
        }
        for (size_t i = 1; i < begin_.size(); ++i)
        {
            begin_[i] += begin_[i - 1];
        }
        points_.resize(points.size());
        std::vector<int> next(begin_.begin(), begin_.end() - 1);
        for (size_t i = 0; i < points.size(); ++i)
        {
            points_[static_cast<size_t>(next[cell(points[i])]++)] = static_cast<int>(i);
        }
    }

    /** Calls f(index) for all points in the cells that touch the square of half side cellPx. */
    template <class F>
    void around(const Eigen::Vector2d& p, const F& f) const
    {
        const Eigen::Vector2d from = p - low_;
        if (!(std::abs(from.x()) < 1e6 && std::abs(from.y()) < 1e6))
        {
            return;
        }
        const int col = index(from.x()), row = index(from.y());
        for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r)
        {
            for (int c = std::max(0, col - 1); c <= std::min(cols_ - 1, col + 1); ++c)
            {
                const auto cell = static_cast<size_t>(r * cols_ + c);
                for (int i = begin_[cell]; i < begin_[cell + 1]; ++i)
                {
                    f(points_[static_cast<size_t>(i)]);
                }
            }
        }
    }

 private:
    [[nodiscard]] int index(double offset) const
    {
        return static_cast<int>(std::floor(offset / cellPx_));
    }
    [[nodiscard]] size_t cell(const Eigen::Vector2d& p) const
    {
        return static_cast<size_t>(index(p.y() - low_.y()) * cols_ + index(p.x() - low_.x()));
    }

    double cellPx_;
    Eigen::Vector2d low_;
    int cols_{0}, rows_{0};
    std::vector<int> begin_, points_;
};

/** Squared L2 distance; four lanes, so that it is vectorised without reordering sums. */
float squaredL2(const float* a, const float* b, int size)
{
    float sum[4] = {};
    int i = 0;
    for (; i + 4 <= size; i += 4)
    {
        for (int k = 0; k < 4; ++k)
        {
            const float d = a[i + k] - b[i + k];
            sum[k] += d * d;
        }
    }
    for (; i < size; ++i)
    {
        sum[0] += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

float descriptorDistance(const cv::Mat& a, int rowA, const cv::Mat& b, int rowB)
{
    if (a.type() == CV_8UC1)
    {
        return static_cast<float>(
            cv::hal::normHamming(a.ptr<uint8_t>(rowA), b.ptr<uint8_t>(rowB), a.cols));
    }
    return std::sqrt(squaredL2(a.ptr<float>(rowA), b.ptr<float>(rowB), a.cols));
}

/** The k current points of nearest descriptor, nearest first [P17, section Matching]. */
std::vector<int> nearestDescriptors(const cv::Mat& refs, int ref, const cv::Mat& curs, int k)
{
    std::vector<std::pair<float, int>> all;
    all.reserve(static_cast<size_t>(curs.rows));
    for (int cur = 0; cur < curs.rows; ++cur)
    {
        all.emplace_back(descriptorDistance(refs, ref, curs, cur), cur);
    }
    const auto end = all.begin() + std::min(k, curs.rows);
    std::partial_sort(all.begin(), end, all.end());
    std::vector<int> out;
    std::transform(
        all.begin(), end, std::back_inserter(out), [](const auto& entry) { return entry.second; });
    return out;
}

constexpr float kNone = std::numeric_limits<float>::max();

/** Current points of the nearest and the second nearest descriptor. */
struct TwoNearest
{
    int cur{-1};
    float distance{kNone}, second{kNone};

    void add(int other, float otherDistance)
    {
        if (otherDistance < distance)
        {
            second = distance;
            cur = other;
            distance = otherDistance;
        }
        else
        {
            second = std::min(second, otherDistance);
        }
    }

    [[nodiscard]] bool isDistinct(double maxRatio) const
    {
        return second == kNone || maxRatio == 1 ||
               static_cast<double>(distance) < maxRatio * static_cast<double>(second);
    }
};

/** Of several claims on a current point, the nearest holds. */
class Claims
{
 public:
    explicit Claims(size_t numCurrent) : distance_(numCurrent, kNone), ref_(numCurrent, -1) {}

    void add(const PointMatch& claim)
    {
        const auto c = static_cast<size_t>(claim.cur);
        if (claim.distance < distance_[c])
        {
            distance_[c] = claim.distance;
            ref_[c] = claim.ref;
        }
    }

    [[nodiscard]] bool holds(const PointMatch& claim) const
    {
        return ref_[static_cast<size_t>(claim.cur)] == claim.ref;
    }

 private:
    std::vector<float> distance_;
    std::vector<int> ref_;
};

void checkInput(const Positions& points, const cv::Mat& descriptors, const char* name)
{
    POINTPLANE_CHECK(
        static_cast<int>(points.size()) == descriptors.rows,
        name << ": " << points.size() << " points but " << descriptors.rows << " descriptors");
}

void checkTypes(const cv::Mat& refDescriptors, const cv::Mat& curDescriptors)
{
    POINTPLANE_CHECK(
        refDescriptors.type() == curDescriptors.type() &&
            refDescriptors.cols == curDescriptors.cols &&
            (refDescriptors.type() == CV_8UC1 || refDescriptors.type() == CV_32FC1),
        "descriptors of the two frames are of different or unknown types");
}

/** The current points that a reference point may be. */
struct Candidates
{
    const PointMatcher::TParams& params;
    const cv::Mat& refDescriptors;
    const Positions& cur_px;
    const cv::Mat& curDescriptors;
    PointGrid grid{cur_px, params.searchRadiusPx};

    /** \param centre where the reference point is expected \param use (const PointMatch&) */
    template <class Use>
    void each(int ref, const Eigen::Vector2d& centre, const Use& use) const
    {
        const double radius = params.searchRadiusPx;
        const auto consider = [&](int cur)
        {
            const auto c = static_cast<size_t>(cur);
            // [P17, section Matching]: the circle around p.
            if (!((cur_px[c] - centre).squaredNorm() <= radius * radius))
            {
                return;
            }
            use({ref, cur, descriptorDistance(refDescriptors, ref, curDescriptors, cur)});
        };
        if (params.neighbours > 0)
        {
            for (const int cur :
                 nearestDescriptors(refDescriptors, ref, curDescriptors, params.neighbours))
            {
                consider(cur);
            }
        }
        else
        {
            grid.around(centre, consider);
        }
    }
};
}  // namespace

void PointMatcher::TParams::check() const
{
    checkRange("searchRadiusPx", searchRadiusPx, 1, 5e4);
    checkRange("neighbours", neighbours, 0, 10000);
    checkRange("maxRatio", maxRatio, 0.01, 1);
}

PointMatcher::PointMatcher(const TParams& params) : params_(params) { params.check(); }

std::vector<PointMatch> PointMatcher::match(
    const Positions& predicted_px,
    const cv::Mat& refDescriptors,
    const Positions& cur_px,
    const cv::Mat& curDescriptors) const
{
    checkInput(predicted_px, refDescriptors, "reference");
    checkInput(cur_px, curDescriptors, "current");
    if (predicted_px.empty() || cur_px.empty())
    {
        return {};
    }
    checkTypes(refDescriptors, curDescriptors);
    const Candidates candidates{params_, refDescriptors, cur_px, curDescriptors};
    std::vector<PointMatch> best;  // per reference point
    Claims claims(cur_px.size());  // of all reference points
    for (int ref = 0; ref < refDescriptors.rows; ++ref)
    {
        TwoNearest nearest;
        const auto add = [&](const PointMatch& candidate)
        {
            nearest.add(candidate.cur, candidate.distance);
            claims.add(candidate);
        };
        candidates.each(ref, predicted_px[static_cast<size_t>(ref)], add);
        if (nearest.cur >= 0 && nearest.isDistinct(params_.maxRatio))
        {
            best.push_back({ref, nearest.cur, nearest.distance});
        }
    }
    if (!params_.crossCheck)
    {
        claims = Claims(cur_px.size());
        std::for_each(best.begin(), best.end(), [&](const PointMatch& m) { claims.add(m); });
    }
    const auto isBeaten = [&](const PointMatch& m) { return !claims.holds(m); };
    best.erase(std::remove_if(best.begin(), best.end(), isBeaten), best.end());
    return best;
}
}  // namespace pointplane
