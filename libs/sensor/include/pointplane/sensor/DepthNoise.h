// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PointGaussian.h>
#include <pointplane/sensor/PinholeCamera.h>

#include <cmath>
#include <string>

namespace pointplane
{
/** Noise of a depth camera, sigma_Z^2 = sigmaDepth^2 + (sigmaRelative Z)^2 + (sigmaInverseDepth
 * Z^2)^2.
 *
 * - sigmaInverseDepth: triangulation (structured light, active stereo) has constant noise in
 *   inverse depth. Of a Kinect, Khoshelham & Elberink 2012 say sigma_Z = 1.425e-6 Z^2 in mm
 *   [P17, after Eq. 2]. In metres this is 1.425e-3 Z^2: 1/Z has 1.425e-3 per metre at every depth.
 * - sigmaDepth: time of flight has constant noise in depth.
 * - sigmaRelative: what bends surfaces, smoothly over many pixels: calibration, several paths of
 *   light, upsampling. */
struct DepthNoise
{
    double sigmaInverseDepth{1.425e-3};  //!< [1/m]
    double sigmaPixelPx{0.5};            //!< [px], key point localisation [P17, after Eq. 2]
    double sigmaDepth{0};                //!< [m]
    double sigmaRelative{0};             //!< of the depth
    std::string kind{"learn"};           //!< what to do about the three; see visit()
    double learntFrom{0}, learntTo{0};   //!< distances [m] that told it; 0: it is given

    /** Standard deviation of a depth reading. \param z [m] \return [m] */
    [[nodiscard]] double sigmaZ(double z) const
    {
        return isConstantInInverseDepth() ? sigmaInverseDepth * z * z
                                          : z * z * std::sqrt(inverseDepthVariance(1 / z));
    }

    /** Depth cameras err by as much of the distance, differently in different parts of the image.
     */
    static constexpr double kDistortion = 0.02;

    /** How far readings of one surface at depth z may be apart: four standard deviations, and
     * distortion. [m] */
    [[nodiscard]] double sameDepth(double z) const
    {
        return std::hypot(4 * sigmaZ(z), kDistortion * z);
    }

    /** Whether a reading at depth z [m] is more than noise. */
    [[nodiscard]] bool tellsDistance(double z) const { return sigmaZ(z) <= 0.25 * z; }

    /** Variance of an inverse depth. \param q [1/m] \return [1/m^2] */
    [[nodiscard]] double inverseDepthVariance(double q) const
    {
        const double relative = sigmaRelative * q, constant = sigmaDepth * q * q;
        return sigmaInverseDepth * sigmaInverseDepth + relative * relative + constant * constant;
    }

    /** Weight of an inverse depth, with which its variance is sigmaInverseDepth^2 at every depth.
     * \param q [1/m] */
    [[nodiscard]] double weight(double q) const
    {
        return isConstantInInverseDepth()
                   ? 1
                   : sigmaInverseDepth * sigmaInverseDepth / inverseDepthVariance(q);
    }

    /** Share of sigmaRelative in inverseDepthVariance(), in [0, 1]. \param q [1/m] */
    [[nodiscard]] double relativeShare(double q) const
    {
        const double relative = sigmaRelative * q;
        return relative * relative / inverseDepthVariance(q);
    }

    [[nodiscard]] bool isConstantInInverseDepth() const
    {
        return sigmaDepth == 0 && sigmaRelative == 0;
    }

    /** The same with all standard deviations of depth times a factor. */
    [[nodiscard]] DepthNoise scaled(double factor) const
    {
        DepthNoise out = *this;
        out.sigmaInverseDepth *= factor;
        out.sigmaDepth *= factor;
        out.sigmaRelative *= factor;
        return out;
    }

    template <class V>
    void visit(V&& v)
    {
        v("kind",
          kind,
          "-",
          "how the depth camera errs: learn (from its images); structuredLight, "
          "activeStereo, timeOfFlight or rendered (if you know it; noise of activeStereo "
          "and timeOfFlight is learnt); given (by the next three keys)");
        v("sigmaInverseDepth",
          sigmaInverseDepth,
          "1/m",
          "noise of depth where it is not learnt: sigma_Z = this * Z^2 (default: a Kinect, "
          "by Khoshelham)");
        v("sigmaDepth", sigmaDepth, "m", "with kind = given: noise that is the same at all depths");
        v("sigmaRelative",
          sigmaRelative,
          "-",
          "with kind = given: smooth error that bends surfaces, as a fraction of the depth");
        v("sigmaPixelPx",
          sigmaPixelPx,
          "px",
          "with method = match: noise of a key point's position (with track: "
          "PointTracker.sigmaPx)");
    }
    /** \throws std::invalid_argument naming the key */
    void check() const;
};

/** One line for users: kind, and noise at 1 m and at 3 m. What was learnt is told only of distances
 * at which it was learnt. */
[[nodiscard]] std::string describe(const DepthNoise& noise);

/** Point at depth z behind a raw pixel, P = z (x, y, 1) [P17 Eq. 1], with its first-order
 * covariance J diag(sigma_p^2, sigma_p^2, sigma_Z^2) J^T [P17 Eq. 2]. Frame: camera, optical axes.
 * \param uv_px raw pixel \param z [m], > 0 */
[[nodiscard]] PointGaussian backProject(
    const PinholeCamera& camera, const DepthNoise& noise, const Eigen::Vector2d& uv_px, double z);

/** The same for a depth whose standard deviation sigmaZ [m] is known from elsewhere.
 * \param sigmaPixelPx of the pixel's position [px] */
[[nodiscard]] PointGaussian backProject(
    const PinholeCamera& camera,
    double sigmaPixelPx,
    double sigmaZ,
    const Eigen::Vector2d& uv_px,
    double z);
}  // namespace pointplane
