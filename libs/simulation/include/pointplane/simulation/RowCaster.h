// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/PinholeCamera.h>
#include <pointplane/simulation/Scene.h>

#include <opencv2/core/matx.hpp>

#include <cstdint>
#include <vector>

namespace pointplane
{
/** Casts the rays of one pixel row, with the camera's pose at that row's instant. Within a row the
 * inverse depth of a plane is linear in the column, and so is every edge condition times it: a
 * rectangle is one interval of columns, without a test per pixel. */
class RowCaster
{
 public:
    /** Keeps references. \param camera without lens distortion */
    RowCaster(const Scene& scene, const PinholeCamera& camera) : scene_(scene), camera_(camera) {}

    /** Sets the row to be cast. \param v row, may be fractional \param t [s], where movers are */
    void setRow(const Eigen::Isometry3d& T_world_cam, double v, double t = 0);

    /** \param inverseDepth out, [1/m] along the optical axis, 0 = nothing there
     * \param id out, index of the surface, -1 = nothing */
    void cast(float* inverseDepth, std::int32_t* id) const;

    /** Colours of a cast row. */
    void shade(const float* inverseDepth, const std::int32_t* id, cv::Vec3b* bgr) const;

    /** Where the ray of column u (may be fractional) of this row hits one surface [1/m]; 0 = it
     * does not. */
    [[nodiscard]] double inverseDepthAt(double u, std::int32_t id) const;

    /** Colour of a surface where that ray hits it. */
    [[nodiscard]] cv::Vec3b colourAt(double u, std::int32_t id, double inverseDepth) const;

 private:
    /** c0 + c1 u: scalar product of a world vector with the row's rays. */
    struct Linear
    {
        double c0, c1;
        [[nodiscard]] double at(double u) const { return c0 + c1 * u; }
    };
    struct Interval
    {
        double low, high;
        void keepPositive(const Linear& f);
        void keepNegative(double a, double b, double c);  //!< a u^2 + b u + c <= 0, a > 0
    };

    /** The row as it is seen from the world or, for its surfaces, from a mover at rest. */
    struct View
    {
        Eigen::Matrix3d R_cam_world{Eigen::Matrix3d::Identity()};
        Eigen::Vector3d eye{0, 0, 0};
        Eigen::Vector3d rayOrigin{0, 0, 1}, rayStep{0, 0, 0};  //!< ray(u) = origin + u step

        [[nodiscard]] Linear along(const Eigen::Vector3d& w) const
        {
            return {w.dot(rayOrigin), w.dot(rayStep)};
        }
        [[nodiscard]] Eigen::Vector3d ray(double u) const { return rayOrigin + u * rayStep; }
    };

    [[nodiscard]] View viewFrom(const Eigen::Isometry3d& T_world_cam) const;
    [[nodiscard]] const View& viewOf(const Surface& s) const
    {
        return views_[static_cast<std::size_t>(s.mover + 1)];
    }
    [[nodiscard]] bool planeInterval(const Surface& s, Linear& q, Interval& interval) const;
    void castCylinder(const Surface& s, std::int32_t id, float* q, std::int32_t* ids) const;
    void shadePlane(const Surface& s, int begin, int end, const float* q, cv::Vec3b* bgr) const;
    [[nodiscard]] float levelOffset(const Surface& s, double above) const;

    const Scene& scene_;
    const PinholeCamera& camera_;
    std::vector<View> views_;  //!< of the world, then of the movers
    double v_{0};
};
}  // namespace pointplane
