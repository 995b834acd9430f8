// SPDX-License-Identifier: BSD-3-Clause
#include "patch_template.h"

#include "patch_kernel.h"

namespace pointplane
{
namespace
{
// A direction is searched when its gradients have this many times the energy of noise's gradients.
constexpr double kMinGradientToNoise = 2;

/** Cubic interpolation, as patch_kernel::sample; adds the variance gain. Pixel must be inside. */
float interpolate(const cv::Mat& image, double u, double v, double& gain)
{
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const patch_kernel::CubicWeights wx(static_cast<float>(u - x)), wy(static_cast<float>(v - y));
    gain += static_cast<double>(wx.noiseGain() * wy.noiseGain());
    const uint8_t* p = image.ptr<uint8_t>(y - 1) + x - 1;
    float out = 0;
    for (int i = 0; i < 4; ++i, p += image.step[0])
    {
        out +=
            wy.w[i] * ((wx.w[0] * static_cast<float>(p[0]) + wx.w[1] * static_cast<float>(p[1])) +
                       (wx.w[2] * static_cast<float>(p[2]) + wx.w[3] * static_cast<float>(p[3])));
    }
    return out;
}
}  // namespace

double sampleWarped(
    const cv::Mat& image,
    const Eigen::Vector2d& centre,
    const Eigen::Matrix2d& A,
    int n,
    float* out)
{
    const double half = 0.5 * (n + 1);
    // A hair wider than needed, as positions are accumulated with rounding.
    const Eigen::Vector2d reach =
        A.cwiseAbs() * Eigen::Vector2d(half, half) + Eigen::Vector2d(1e-6, 1e-6);
    if (!isInside(
            image,
            centre.x() - reach.x(),
            centre.y() - reach.y(),
            centre.x() + reach.x(),
            centre.y() + reach.y()))
    {
        return 0;
    }
    double gain = 0;
    for (int y = 0; y < n + 2; ++y)
    {
        Eigen::Vector2d p = centre + A * Eigen::Vector2d(-half, y - half);
        for (int x = 0; x < n + 2; ++x)
        {
            *out++ = interpolate(image, p.x(), p.y(), gain);
            p += A.col(0);
        }
    }
    return gain / ((n + 2) * (n + 2));
}

void fillLevel(
    const float* samples,
    const PatchAligner::TParams& params,
    PatchReference::Level& level,
    float* data)
{
    const int n = params.patchSizePx, count = n * n, stride = n + 2;
    float *T = data, *Tx = data + count, *Ty = data + 2 * count;
    double sum = 0, sumX = 0, sumY = 0;
    for (int i = 0; i < count; ++i)
    {
        const float* s = samples + (i / n + 1) * stride + i % n + 1;
        T[i] = s[0];
        Tx[i] = 0.5F * (s[1] - s[-1]);
        Ty[i] = 0.5F * (s[stride] - s[-stride]);
        sum += static_cast<double>(T[i]);
        sumX += static_cast<double>(Tx[i]);
        sumY += static_cast<double>(Ty[i]);
    }
    level.mean = static_cast<float>(sum / count);
    const auto meanX = static_cast<float>(sumX / count), meanY = static_cast<float>(sumY / count);
    float energy = 0, tx = 0, ty = 0;
    for (int i = 0; i < count; ++i)
    {
        T[i] -= level.mean;
        energy += T[i] * T[i];
        tx += T[i] * Tx[i];
        ty += T[i] * Ty[i];
    }
    level.energy = energy;
    level.isUsable = static_cast<double>(energy) >= count * params.minContrast * params.minContrast;
    if (!level.isUsable)
    {
        return;
    }
    double hxx = 0, hxy = 0, hyy = 0;
    for (int i = 0; i < count; ++i)
    {
        Tx[i] -= meanX + tx / energy * T[i];  // orthogonal to bias and gain
        Ty[i] -= meanY + ty / energy * T[i];
        hxx += static_cast<double>(Tx[i] * Tx[i]);
        hxy += static_cast<double>(Tx[i] * Ty[i]);
        hyy += static_cast<double>(Ty[i] * Ty[i]);
    }
    level.hessian << hxx, hxy, hxy, hyy;
    // Directions with nothing but noise to follow are left alone (aperture problem); a patch
    // explained by gain and bias alone, such as a ramp, has contrast but no direction left.
    const double least =
        kMinGradientToNoise * gradientNoise(count, level, params.noise * params.noise);
    const EigenSolver2 es(level.hessian);
    Eigen::Vector2d inverse(0, 0);
    for (int i = 0; i < 2; ++i)
    {
        inverse[i] = es.eigenvalues()[i] > least ? 1 / es.eigenvalues()[i] : 0;
    }
    level.inverse = es.eigenvectors() * inverse.asDiagonal() * es.eigenvectors().transpose();
    level.isUsable = inverse[1] > 0;
}
}  // namespace pointplane
