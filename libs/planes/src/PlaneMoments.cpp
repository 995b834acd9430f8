// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneMoments.h>

#include <algorithm>

namespace pointplane
{
void PlaneMoments::add(double ray_x, double ray_y, double inverseDepth, double weight)
{
    n += weight;
    x += weight * ray_x;
    y += weight * ray_y;
    xx += weight * ray_x * ray_x;
    xy += weight * ray_x * ray_y;
    yy += weight * ray_y * ray_y;
    q += weight * inverseDepth;
    xq += weight * ray_x * inverseDepth;
    yq += weight * ray_y * inverseDepth;
    qq += weight * inverseDepth * inverseDepth;
    numPixels += 1;
}

PlaneMoments& PlaneMoments::operator*=(double weight)
{
    for (double* sum : {&n, &x, &y, &xx, &xy, &yy, &q, &xq, &yq, &qq})
    {
        *sum *= weight;
    }
    return *this;
}

PlaneMoments& PlaneMoments::operator+=(const PlaneMoments& other)
{
    n += other.n;
    x += other.x;
    y += other.y;
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    q += other.q;
    xq += other.xq;
    yq += other.yq;
    qq += other.qq;
    numPixels += other.numPixels;
    return *this;
}

Eigen::Matrix3d PlaneMoments::rayMatrix() const
{
    Eigen::Matrix3d A;
    A << xx, xy, x, xy, yy, y, x, y, n;
    return A;
}

std::optional<MomentsFit> fitPlane(const PlaneMoments& m)
{
    if (m.numPixels < 3)
    {
        return std::nullopt;
    }
    // Centred normal equations: a 2x2 solve, exact and free of the cancellation of the 3x3 one.
    const double mx = m.x / m.n, my = m.y / m.n, mq = m.q / m.n;
    const double cxx = m.xx - mx * m.x, cxy = m.xy - mx * m.y, cyy = m.yy - my * m.y;
    const double cxq = m.xq - mx * m.q, cyq = m.yq - my * m.q, cqq = m.qq - mq * m.q;
    const double det = cxx * cyy - cxy * cxy;
    if (!(det > 1e-9 * (cxx + cyy) * (cxx + cyy)))
    {
        return std::nullopt;
    }
    const double a = -(cyy * cxq - cxy * cyq) / det;
    const double b = -(cxx * cyq - cxy * cxq) / det;
    const double c = -(mq + a * mx + b * my);
    return MomentsFit{Eigen::Vector3d(a, b, c), std::max(0.0, cqq + a * cxq + b * cyq)};
}
}  // namespace pointplane
