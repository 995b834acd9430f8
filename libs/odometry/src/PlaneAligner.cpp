// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneAligner.h"

#include <pointplane/core/se3.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace pointplane
{
namespace
{
/** Of a frame, the largest planes: they are seen from elsewhere, too. */
constexpr size_t kMostPlanes = 6;

std::vector<Plane> largestPlanes(const PlaneSet& set)
{
    std::vector<const PlaneFeature*> sorted;
    for (const PlaneFeature& plane : set.planes)
    {
        sorted.push_back(&plane);
    }
    std::stable_sort(
        sorted.begin(),
        sorted.end(),
        [](const PlaneFeature* a, const PlaneFeature* b) { return a->numPixels > b->numPixels; });
    sorted.resize(std::min(sorted.size(), kMostPlanes));
    std::vector<Plane> out;
    for (const PlaneFeature* plane : sorted)
    {
        out.push_back(hessianForm(plane->plane_cam.theta_m));
    }
    return out;
}

/** A plane of the reference, and the one that it may be now. */
struct PlanePairing
{
    const Plane& ref;
    const Plane& cur;

    /** How far the motion goes along the normal that the plane has now [m]. */
    [[nodiscard]] double way() const { return ref.d - cur.d; }
};

/** By two normals, and the one across both, which tells turned pairs from mirrored ones. */
Eigen::Matrix3d rotationOf(const PlanePairing& a, const PlanePairing& b)
{
    return nearestRotation(
        a.cur.n * a.ref.n.transpose() + b.cur.n * b.ref.n.transpose() +
        a.cur.n.cross(b.cur.n) * a.ref.n.cross(b.ref.n).transpose());
}

/** Lays planes of one frame over those of another. */
class Search
{
 public:
    Search(
        std::vector<Plane> refs,
        std::vector<Plane> curs,
        const MatchedPoints& points,
        const PlaneAligner& alike)
        : refs_(std::move(refs)), curs_(std::move(curs)), points_(points), alike_(alike)
    {
    }

    [[nodiscard]] std::vector<Eigen::Isometry3d> motions()
    {
        for (auto a = refs_.begin(); a != refs_.end(); ++a)
        {
            for (auto b = std::next(a); b != refs_.end(); ++b)
            {
                for (const Plane& nowA : curs_)
                {
                    for (const Plane& nowB : curs_)
                    {
                        addOfPair({*a, nowA}, {*b, nowB});
                    }
                }
            }
        }
        return std::move(motions_);
    }

 private:
    void addOfPair(const PlanePairing& a, const PlanePairing& b)
    {
        if (tellNoTurn(a.ref.n, b.ref.n) || tellNoTurn(a.cur.n, b.cur.n))
        {
            return;
        }
        const Eigen::Matrix3d R = rotationOf(a, b);
        if (!turns(R, a) || !turns(R, b))
        {
            return;
        }
        for (const Plane& ref : refs_)
        {
            for (const Plane& cur : curs_)
            {
                addOfTriple(R, a, b, {ref, cur});
            }
        }
        for (size_t i = 0; i < points_.ref.size(); ++i)
        {
            const Eigen::Vector3d t = points_.cur[i] - R * points_.ref[i];
            if (alike_.areNear(a.cur.n.dot(t), a.way()) && alike_.areNear(b.cur.n.dot(t), b.way()))
            {
                add(R, t);
            }
        }
    }

    void addOfTriple(
        const Eigen::Matrix3d& R,
        const PlanePairing& a,
        const PlanePairing& b,
        const PlanePairing& third)
    {
        const Eigen::Vector3d across = a.cur.n.cross(b.cur.n).normalized();
        if (!turns(R, third) || alike_.isAcross(third.cur.n, across))
        {
            return;  // a different plane, or one that tells nothing more
        }
        Eigen::Matrix3d normals;
        normals << a.cur.n.transpose(), b.cur.n.transpose(), third.cur.n.transpose();
        add(R, normals.inverse() * Eigen::Vector3d(a.way(), b.way(), third.way()));
    }

    /** Whether planes lie along each other, or face each other: a turn about their normals does not
     * show. */
    [[nodiscard]] bool tellNoTurn(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const
    {
        return alike_.areParallel(a, b) || alike_.areParallel(a, -b);
    }

    /** Whether the rotation turns the plane of the reference to where it may be now. */
    [[nodiscard]] bool turns(const Eigen::Matrix3d& R, const PlanePairing& pair) const
    {
        return alike_.areParallel(R * pair.ref.n, pair.cur.n);
    }

    void add(const Eigen::Matrix3d& R, const Eigen::Vector3d& t)
    {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = R;
        T.translation() = t;
        const auto isSame = [&](const Eigen::Isometry3d& other)
        { return alike_.areAlike(T, other); };
        if (std::none_of(motions_.begin(), motions_.end(), isSame))
        {
            motions_.push_back(T);
        }
    }

    std::vector<Plane> refs_, curs_;
    const MatchedPoints& points_;
    const PlaneAligner& alike_;
    std::vector<Eigen::Isometry3d> motions_;
};
}  // namespace

PlaneAligner::PlaneAligner(const PlaneMatcher::TParams& alike)
    : angle_(alike.maxNormalAngleDeg * M_PI / 180), distance_(alike.maxDistance)
{
}

bool PlaneAligner::areParallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const
{
    return a.dot(b) > std::cos(angle_);
}

bool PlaneAligner::isAcross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const
{
    return std::abs(a.dot(b)) < std::sin(angle_);
}

bool PlaneAligner::areNear(double a, double b) const { return std::abs(a - b) < distance_; }

bool PlaneAligner::areAlike(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const
{
    const Eigen::Isometry3d T = a.inverse() * b;
    return T.translation().norm() < distance_ && so3Log(T.linear()).norm() < angle_;
}

std::vector<Eigen::Isometry3d> PlaneAligner::motions(
    const PlaneSet& ref, const PlaneSet& cur, const MatchedPoints& points) const
{
    return Search(largestPlanes(ref), largestPlanes(cur), points, *this).motions();
}
}  // namespace pointplane
