// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/RowCaster.h>

#include <cmath>
#include <cstring>

namespace pointplane
{
namespace
{
constexpr double kMinInverseDepth = 0.01;
/** Stands for a plane's distance / depth in the choice of a level of detail. */
constexpr double kCylinderSlope = 0.6;

/** log2, continuous and within 0.09: enough to choose a level of detail. */
float coarseLog2(float x)
{
    std::int32_t bits = 0;
    std::memcpy(&bits, &x, sizeof(bits));
    return static_cast<float>(bits) * 0x1p-23F - 127.0F;
}

cv::Vec3b toBgr(std::uint64_t lanes)
{
    return {
        static_cast<uchar>(lanes),
        static_cast<uchar>(lanes >> 16),
        static_cast<uchar>(lanes >> 32)};
}
}  // namespace

void RowCaster::Interval::keepPositive(const Linear& f)
{
    if (f.c1 > 0)
    {
        low = std::max(low, -f.c0 / f.c1);
    }
    else if (f.c1 < 0)
    {
        high = std::min(high, -f.c0 / f.c1);
    }
    else if (f.c0 < 0)
    {
        high = low - 1;
    }
}

void RowCaster::Interval::keepNegative(double a, double b, double c)
{
    const double discriminant = b * b - 4 * a * c;
    if (discriminant < 0)
    {
        high = low - 1;
        return;
    }
    const double root = std::sqrt(discriminant);
    low = std::max(low, (-b - root) / (2 * a));
    high = std::min(high, (-b + root) / (2 * a));
}

RowCaster::View RowCaster::viewFrom(const Eigen::Isometry3d& T_world_cam) const
{
    View out;
    out.R_cam_world = T_world_cam.linear().transpose();
    out.eye = T_world_cam.translation();
    out.rayStep = T_world_cam.linear().col(0) / camera_.fx;
    out.rayOrigin = T_world_cam.linear() *
                    Eigen::Vector3d(-camera_.cx / camera_.fx, (v_ - camera_.cy) / camera_.fy, 1);
    return out;
}

void RowCaster::setRow(const Eigen::Isometry3d& T_world_cam, double v, double t)
{
    v_ = v;
    views_.clear();
    views_.push_back(viewFrom(T_world_cam));
    for (const Mover& mover : scene_.movers)
    {
        views_.push_back(viewFrom(mover.T_world_rest(t).inverse() * T_world_cam));
    }
}

bool RowCaster::planeInterval(const Surface& s, Linear& q, Interval& interval) const
{
    const View& view = viewOf(s);
    const Eigen::Vector3d o = view.eye - s.origin;
    const double above = o.dot(s.e3);
    if (above <= 1e-6)
    {
        return false;
    }
    const Linear n = view.along(s.e3);
    q = {-n.c0 / above, -n.c1 / above};
    interval.keepPositive({q.c0 - kMinInverseDepth, q.c1});
    // Position on the plane times q.
    const double so = o.dot(s.e1), to = o.dot(s.e2);
    const Linear e1 = view.along(s.e1), e2 = view.along(s.e2);
    const Linear sq{e1.c0 + so * q.c0, e1.c1 + so * q.c1};
    const Linear tq{e2.c0 + to * q.c0, e2.c1 + to * q.c1};
    if (s.kind == Surface::Kind::Rectangle)
    {
        interval.keepPositive(sq);
        interval.keepPositive({s.width * q.c0 - sq.c0, s.width * q.c1 - sq.c1});
        interval.keepPositive(tq);
        interval.keepPositive({s.height * q.c0 - tq.c0, s.height * q.c1 - tq.c1});
    }
    else
    {
        const double r2 = s.radius * s.radius;
        const double a = sq.c1 * sq.c1 + tq.c1 * tq.c1 - r2 * q.c1 * q.c1;
        if (a <= 0)
        {
            return false;  // the eye is within the lid's height of the axis: not a camera's view
        }
        interval.keepNegative(
            a,
            2 * (sq.c0 * sq.c1 + tq.c0 * tq.c1 - r2 * q.c0 * q.c1),
            sq.c0 * sq.c0 + tq.c0 * tq.c0 - r2 * q.c0 * q.c0);
    }
    return interval.low <= interval.high;
}

void RowCaster::cast(float* inverseDepth, std::int32_t* id) const
{
    std::fill(inverseDepth, inverseDepth + camera_.width, 0.0F);
    std::fill(id, id + camera_.width, -1);
    for (std::size_t k = 0; k < scene_.surfaces.size(); ++k)
    {
        const Surface& s = scene_.surfaces[k];
        const auto index = static_cast<std::int32_t>(k);
        if (s.kind == Surface::Kind::Cylinder)
        {
            castCylinder(s, index, inverseDepth, id);
            continue;
        }
        Linear q{0, 0};
        Interval interval{0, static_cast<double>(camera_.width - 1)};
        if (!planeInterval(s, q, interval))
        {
            continue;
        }
        const int begin = static_cast<int>(std::ceil(interval.low));
        const int end = static_cast<int>(std::floor(interval.high)) + 1;
        const auto q0 = static_cast<float>(q.c0), q1 = static_cast<float>(q.c1);
        for (int u = begin; u < end; ++u)
        {
            const float here = q0 + q1 * static_cast<float>(u);
            const bool nearer = here > inverseDepth[u];
            inverseDepth[u] = nearer ? here : inverseDepth[u];
            id[u] = nearer ? index : id[u];
        }
    }
}

void RowCaster::castCylinder(const Surface& s, std::int32_t id, float* q, std::int32_t* ids) const
{
    const View& view = viewOf(s);
    const Eigen::Vector3d centre = view.R_cam_world * (s.origin + 0.5 * s.height * s.e3 - view.eye);
    const double reach = std::hypot(0.5 * s.height, s.radius);
    double low = 0, high = camera_.width - 1;
    if (centre.z() > 2 * reach)
    {
        // Bounding sphere -> bounding box in the image.
        const auto bound = [&](double x, bool upper)
        {
            const double edge = upper ? x + reach : x - reach;
            return edge / (centre.z() + ((edge > 0) == upper ? -reach : reach));
        };
        const double row = (v_ - camera_.cy) / camera_.fy;
        if (row < bound(centre.y(), false) || row > bound(centre.y(), true))
        {
            return;
        }
        low = std::max(low, camera_.fx * bound(centre.x(), false) + camera_.cx);
        high = std::min(high, camera_.fx * bound(centre.x(), true) + camera_.cx);
    }
    else if (centre.z() < -reach)
    {
        return;
    }
    for (int u = static_cast<int>(std::ceil(low)); u <= static_cast<int>(std::floor(high)); ++u)
    {
        const auto here = static_cast<float>(s.inverseDepth(view.eye, view.ray(u)));
        if (here > q[u])
        {
            q[u] = here;
            ids[u] = id;
        }
    }
}

float RowCaster::levelOffset(const Surface& s, double above) const
{
    // A pixel covers z / f across and z / (f cos) along the slope, 1 / cos = z / above. The mean
    // of both with weight 3/4 on the longer one: log2(z / f) + 3/4 log2(z / above) - log2(texel).
    return -coarseLog2(static_cast<float>(camera_.fx * s.texture.texel())) -
           0.75F * coarseLog2(static_cast<float>(above));
}

void RowCaster::shade(const float* inverseDepth, const std::int32_t* id, cv::Vec3b* bgr) const
{
    int begin = 0;
    while (begin < camera_.width)
    {
        int end = begin + 1;
        while (end < camera_.width && id[end] == id[begin])
        {
            ++end;
        }
        if (id[begin] < 0)
        {
            std::fill(bgr + begin, bgr + end, cv::Vec3b(0, 0, 0));
        }
        else
        {
            const Surface& s = scene_.surfaces[static_cast<std::size_t>(id[begin])];
            if (s.isPlane())
            {
                shadePlane(s, begin, end, inverseDepth, bgr);
            }
            else
            {
                for (int u = begin; u < end; ++u)
                {
                    bgr[u] = colourAt(u, id[begin], static_cast<double>(inverseDepth[u]));
                }
            }
        }
        begin = end;
    }
}

void RowCaster::shadePlane(
    const Surface& s, int begin, int end, const float* q, cv::Vec3b* bgr) const
{
    const View& view = viewOf(s);
    const Eigen::Vector3d o = view.eye - s.origin;
    const double perTexel = 1 / s.texture.texel();
    const double middle = s.kind == Surface::Kind::Disc ? s.radius : 0;
    const Linear e1 = view.along(s.e1), e2 = view.along(s.e2);
    const auto x0 = static_cast<float>((o.dot(s.e1) + middle) * perTexel - 0.5);
    const auto y0 = static_cast<float>((o.dot(s.e2) + middle) * perTexel - 0.5);
    const auto xa = static_cast<float>(e1.c0 * perTexel), xb = static_cast<float>(e1.c1 * perTexel);
    const auto ya = static_cast<float>(e2.c0 * perTexel), yb = static_cast<float>(e2.c1 * perTexel);
    const float level = levelOffset(s, o.dot(s.e3));
    constexpr int kChunk = 64;
    float x[kChunk], y[kChunk], lod[kChunk];
    for (int start = begin; start < end; start += kChunk)
    {
        const int count = std::min(kChunk, end - start);
        for (int i = 0; i < count; ++i)
        {
            const float z = 1.0F / q[start + i];
            const auto column = static_cast<float>(start + i);
            x[i] = x0 + z * (xa + xb * column);
            y[i] = y0 + z * (ya + yb * column);
            lod[i] = level + 1.75F * coarseLog2(z);
        }
        for (int i = 0; i < count; ++i)
        {
            s.texture.prefetch(x[i], y[i], lod[i]);
        }
        for (int i = 0; i < count; ++i)
        {
            bgr[start + i] = toBgr(s.texture.sample(x[i], y[i], lod[i]));
        }
    }
}

double RowCaster::inverseDepthAt(double u, std::int32_t id) const
{
    const Surface& s = scene_.surfaces[static_cast<std::size_t>(id)];
    const View& view = viewOf(s);
    return s.inverseDepth(view.eye, view.ray(u));
}

cv::Vec3b RowCaster::colourAt(double u, std::int32_t id, double inverseDepth) const
{
    const Surface& s = scene_.surfaces[static_cast<std::size_t>(id)];
    const View& view = viewOf(s);
    const Eigen::Vector3d point = view.eye + view.ray(u) / inverseDepth;
    const Eigen::Vector2d at =
        s.worldToPicture(point) / s.texture.texel() - Eigen::Vector2d::Constant(0.5);
    const bool plane = s.isPlane();
    const double above = plane ? (view.eye - s.origin).dot(s.e3) : kCylinderSlope;
    const float lod = levelOffset(s, above) +
                      (plane ? 1.75F : 1.0F) * coarseLog2(static_cast<float>(1 / inverseDepth));
    return toBgr(s.texture.sample(static_cast<float>(at.x()), static_cast<float>(at.y()), lod));
}
}  // namespace pointplane
