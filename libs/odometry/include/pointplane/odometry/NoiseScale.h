// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/pose/PoseSolver.h>

namespace pointplane
{
/** The variance of a camera's points and planes over the propagated one.
 *
 * Residuals of the frames so far tell how large errors are that differ between features; sensors
 * differ by more than a factor of ten here. Errors that the features of a frame have in common show
 * where reference frames contradict each other about the pose. What all references share shows
 * nowhere: a constant factor stands for it (docs/theory.md). */
class NoiseScale
{
 public:
    struct TParams
    {
        bool adaptive{true};
        double timeConstant{1.0};
        double agreementTimeConstant{2.0};
        double pointFactor{3.5};
        double planeFactor{3.5};

        template <class V>
        void visit(V&& v)
        {
            v("adaptive",
              adaptive,
              "-",
              "the variance of points and planes follows that of their residuals");
            v("timeConstant", timeConstant, "s", "over which it follows");
            v("agreementTimeConstant",
              agreementTimeConstant,
              "s",
              "over which it follows the disagreement of the reference frames");
            v("pointFactor",
              pointFactor,
              "-",
              "true variance of points over that, for errors that all references share");
            v("planeFactor", planeFactor, "-", "true variance of planes over that");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    explicit NoiseScale(const TParams& params);

    /** Takes in a measured frame, `dt` [s] after the one before. */
    void update(const PoseEstimate& estimate, double dt);

    [[nodiscard]] NoiseFactors factors() const;

 private:
    TParams params_;
    NoiseFactors residuals_;  //!< by the residuals alone
    NoiseFactors common_;     //!< over that, by the disagreement of the references
};
}  // namespace pointplane
