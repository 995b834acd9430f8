// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/odometry/uncertainty/FrameMean.h>
#include <pointplane/pose/PoseSolver.h>

namespace pointplane
{
/** Learns the variance of points and planes, over the propagated one.
 *
 * Residuals tell how large errors are that differ between features; sensors differ by more than a
 * factor of ten in this. Errors that the features of a frame have in common do not show in
 * residuals. They show where reference frames contradict each other about the pose (docs/theory.md,
 * Noise of features). And some frames are worse than others: there, the parts of the image pull the
 * pose apart.
 *
 * It learns slowly. A depth image that bends for a second makes points look worse and planes
 * better; a pose that believed this at once would follow the bent image. */
class NoiseScale
{
 public:
    struct TParams
    {
        bool adaptive{true};
        double timeConstant{2.0};
        double pointFactor{3.5};
        double planeFactor{3.5};

        template <class V>
        void visit(V&& v)
        {
            v("adaptive",
              adaptive,
              "-",
              "learn the variance of points and planes from their residuals");
            v("timeConstant", timeConstant, "s", "time over which it is learnt");
            v("pointFactor",
              pointFactor,
              "-",
              "factor on the variance of points; larger = trust the predicted motion more");
            v("planeFactor", planeFactor, "-", "the same of planes");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    /** What a frame says, between a tenth and a hundred times the propagated variance: a few odd
     * frames must neither make features certain nor worthless. */
    [[nodiscard]] static double plausible(double variance);

    /** \throws std::invalid_argument naming the key */
    explicit NoiseScale(const TParams& params);

    /** Learns from a measured frame, `dt` [s] after the one before.
     * \param tells whether residuals tell its noise: if not, it counts as a usual one */
    void update(const PoseAnalysis& analysis, double dt, bool tells = true);

    /** For the solver: with the constant factors, by which features are weighed against a predicted
     * motion. */
    [[nodiscard]] NoiseFactors factors() const;

    /** Variance of the residuals so far over the one that factors() starts with, out of caution:
     * that of points, or of planes if there are no points. */
    [[nodiscard]] double overCautious() const;

    /** Variance of the errors of the latest frame over that of a usual one: its scatter
     * (PoseAnalysis) over the geometric mean of those before, which single bad frames hardly move.
     */
    [[nodiscard]] double ofFrame() const { return ofFrame_; }

    /** What the points of a frame usually have, for covariances: geometric means, which soon forget
     * what the first frames said. A camera that turns fast in these has residuals of 50 times the
     * propagated variance. */
    struct TypicalPoints
    {
        double residuals;     //!< variance, over the propagated one
        double disagreement;  //!< how much more the references contradict each other
        double turnVariance;  //!< PoseAnalysis::turnVariance; 0 = no points so far
    };
    [[nodiscard]] TypicalPoints typicalPoints() const;

    /** Learnt from the residuals alone. */
    [[nodiscard]] NoiseFactors residuals() const
    {
        return {pointResiduals_.quick.value(), planeResiduals_.quick.value()};
    }

 private:
    void learn(const PoseAnalysis& analysis, double rate);

    /** Of the residuals alone. */
    struct Residuals
    {
        explicit Residuals(double first);
        void follow(double variance, double rate);
        FrameMean cautious;  //!< for the solver
        FrameMean quick;
    };

    TParams params_;
    Residuals pointResiduals_, planeResiduals_;
    FrameMean pointCommon_, planeCommon_;  //!< over that, by the references' disagreement
    /** Logarithms, for geometric means. */
    FrameMean typicalResiduals_, typicalDisagreement_, typicalTurn_, typicalScatter_;
    double ofFrame_{1};
};
}  // namespace pointplane
