// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>

#include <string>

namespace pointplane
{
/** How large errors are that residuals do not show. */
struct CovarianceParams
{
    std::string model{"joint"};
    double noise{0.22};
    double viewNoise{34};
    double vignetting{0.15};
    double principalPoint{0.3};
    double focalLength{0.0006};
    double depthScale{0.005};
    int history{1};

    template <class V>
    void visit(V&& v)
    {
        v("model",
          model,
          "-",
          "joint (frames that are compared with the same references err together) or "
          "independent (each increment by itself, as in the paper)");
        v("noise",
          noise,
          "-",
          "fraction of the variance of the points' residuals that is noise of this frame; the "
          "rest is noise of the references and error that the points share");
        v("viewNoise",
          viewNoise,
          "-",
          "how large the error is that all points of a frame share, as a multiple of how far "
          "the references contradict each other; twice the value makes standard deviations "
          "over a second 1.1 to 1.9 times as large; 17 to 68 are sensible");
        v("vignetting",
          vignetting,
          "-",
          "how much darker the image's corners may be than its centre (standard deviation, "
          "fraction of the brightness); the odometry can take this for motion");
        v("principalPoint",
          principalPoint,
          "px",
          "error of the calibration: standard deviation of cx and cy");
        v("focalLength",
          focalLength,
          "-",
          "error of the calibration: standard deviation of fx and fy together, as a "
          "fraction");
        v("depthScale",
          depthScale,
          "-",
          "error of the depth camera: standard deviation of the scale of all depths, as a "
          "fraction");
        v("history",
          history,
          "frames",
          "covariances of motions are kept for this many frames back (--since raises it)");
    }
    /** \throws std::invalid_argument naming the key */
    void check() const;
    [[nodiscard]] bool isJoint() const;  //!< model is joint, not independent
};
}  // namespace pointplane
