// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/core/range.h>
#include <pointplane/sensor/DepthNoise.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <vector>

namespace pointplane
{
void DepthNoise::check() const
{
    constexpr std::array kinds{
        "learn", "structuredLight", "activeStereo", "timeOfFlight", "rendered", "given"};
    POINTPLANE_CHECK(
        std::find(kinds.begin(), kinds.end(), kind) != kinds.end(),
        "kind = "
            << kind
            << " is not learn, structuredLight, activeStereo, timeOfFlight, rendered or given");
    checkRange("sigmaInverseDepth", sigmaInverseDepth, 1e-7, 0.09);
    checkLength("sigmaDepth", sigmaDepth, 0, 0.5);
    checkRange("sigmaRelative", sigmaRelative, 0, 1);
    checkRange("sigmaPixelPx", sigmaPixelPx, 0.001, 100);
}

std::string describe(const DepthNoise& noise)
{
    DepthNoise unbent = noise;
    unbent.sigmaRelative = 0;
    std::vector<double> distances{1, 3};
    if (noise.learntTo > 0)
    {
        const auto isUnseen = [&](double z) { return z < noise.learntFrom || z > noise.learntTo; };
        distances.erase(
            std::remove_if(distances.begin(), distances.end(), isUnseen), distances.end());
        if (distances.empty())
        {
            distances.push_back(std::sqrt(noise.learntFrom * noise.learntTo));
        }
    }
    std::ostringstream out = numberStream();
    out << std::setprecision(2)
        << (noise.kind != "learn" ? noise.kind
            : noise.learntTo > 0  ? "of a kind that shows beyond 0.75 m"
                                  : "assumed (nothing told it)");
    for (const double z : distances)
    {
        out << ", " << 1e3 * unbent.sigmaZ(z) << " mm at " << z << " m";
    }
    if (noise.sigmaRelative > 0)
    {
        out << "; surfaces count as bent by " << 100 * noise.sigmaRelative << " % of their depth";
    }
    return out.str();
}

PointGaussian backProject(
    const PinholeCamera& camera, const DepthNoise& noise, const Eigen::Vector2d& uv_px, double z)
{
    return backProject(camera, noise.sigmaPixelPx, noise.sigmaZ(z), uv_px, z);
}

PointGaussian backProject(
    const PinholeCamera& camera,
    double sigmaPixelPx,
    double sigmaZ,
    const Eigen::Vector2d& uv_px,
    double z)
{
    Eigen::Matrix2d xyOverPixel;
    const Eigen::Vector2d xy = camera.normalised(uv_px, &xyOverPixel);
    const Eigen::Vector3d ray(xy.x(), xy.y(), 1);
    const Eigen::Matrix2d lateral = z * sigmaPixelPx * xyOverPixel;
    PointGaussian out;
    out.mean = z * ray;                                 // [P17 Eq. 1]
    out.cov = sigmaZ * sigmaZ * ray * ray.transpose();  // [P17 Eq. 2]
    out.cov.topLeftCorner<2, 2>() += lateral * lateral.transpose();
    return out;
}
}  // namespace pointplane
