// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/pose/PoseSolver.h>

namespace pointplane
{
/** How much larger than modelled the errors of a camera's points and planes are, from the residuals
 * of the frames so far. */
class NoiseScale
{
 public:
    struct TParams
    {
        bool adaptive{true};
        double timeConstant{1.0};
        double initial{4.0};
        double pointFactor{4.0};
        double planeFactor{4.0};

        template <class V>
        void visit(V&& v)
        {
            v("adaptive",
              adaptive,
              "-",
              "the variance of points and planes follows that of their residuals");
            v("timeConstant", timeConstant, "s", "of the average over frames");
            v("pointFactor", pointFactor, "-", "true variance over that of the residuals, points");
            v("planeFactor", planeFactor, "-", "true variance over that of the residuals, planes");
            v("initial", initial, "-", "true variance over the propagated one, at the start");
        }
        void check() const;
    };

    explicit NoiseScale(const TParams& params);

    /** Takes in the reduced chi-squares of a measured frame, `dt` [s] after the one before. */
    void update(const PoseEstimate& estimate, double dt);

    [[nodiscard]] NoiseFactors factors() const { return {factors_.points * params_.pointFactor, factors_.planes * params_.planeFactor}; }

 private:
    TParams params_;
    NoiseFactors factors_;
};
}  // namespace pointplane
