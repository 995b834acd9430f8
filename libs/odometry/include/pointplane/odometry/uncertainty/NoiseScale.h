// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/odometry/uncertainty/FrameMean.h>
#include <pointplane/pose/PoseSolver.h>

namespace pointplane
{
/** Learns the noise of points and planes: the ratio of their variance to the propagated one
 * (variance factors).
 *
 * Residuals show the errors that are independent between features. Sensors differ by more than a
 * factor of ten in these. Errors that the features of a frame have in common do not show in
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

    /** Standard deviations may be so many times the propagated ones, and variances that part of
     * them. Where noise is larger, features are not where the motion puts them. */
    static constexpr double kMostChange = 10;
    static constexpr double kLeastVariance = 1 / kMostChange;
    static constexpr double kMostVariance = kMostChange * kMostChange;

    /** Clamps a variance factor to these: a few odd frames must neither make features certain nor
     * worthless. */
    [[nodiscard]] static double plausible(double variance);

    /** \throws std::invalid_argument naming the key */
    explicit NoiseScale(const TParams& params);

    /** Learns from a measured frame, `dt` [s] after the one before.
     * \param tells whether residuals tell its noise: if not, it counts as a usual one */
    void update(const PoseAnalysis& analysis, double dt, bool tells);

    /** For the solver: variance of the residuals, times the references' disagreement, times the
     * constant factors, by which features count less against a predicted motion. */
    [[nodiscard]] NoiseFactors factors() const;

    /** Variance of the residuals, as residuals() and as factors() have it: their ratio. Below one
     * while factors() still holds its cautious first guess. Of points, or of planes if there are no
     * points. */
    [[nodiscard]] double overCautious() const;

    /** Variance of the errors of the latest frame over that of a usual one (phi in docs/theory.md):
     * its scatter (PoseAnalysis) over the geometric mean of those before, which single bad frames
     * hardly move. */
    [[nodiscard]] double ofFrame() const { return ofFrame_; }

    /** What the points of a frame usually have, for covariances: geometric means, which soon forget
     * what the first frames said. A camera that turns fast in these has residuals of 50 times the
     * propagated variance. */
    struct TypicalPoints
    {
        double residuals;     //!< variance, over the propagated one (v in docs/theory.md)
        double disagreement;  //!< variance by which references contradict each other, over that (u)
        double turnVariance;  //!< PoseAnalysis::turnVariance; 0 = no points so far
    };
    [[nodiscard]] TypicalPoints typicalPoints() const;

    /** Variance of the residuals, over the propagated one; the first guess is soon forgotten. */
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
        FrameMean<>
            cautious;       //!< for the solver: forgets the first guess by the time constant only
        FrameMean<> quick;  //!< forgets it after a few frames
    };

    TParams params_;
    Residuals pointResiduals_, planeResiduals_;
    FrameMean<> pointCommon_, planeCommon_;  //!< disagreement of the references
    /** Logarithms, for geometric means. */
    FrameMean<> typicalResiduals_, typicalDisagreement_, typicalTurn_, typicalScatter_;
    double ofFrame_{1};
};
}  // namespace pointplane
