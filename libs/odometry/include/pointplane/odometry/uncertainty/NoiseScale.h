// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
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

    /** Variance before anything is known; for the solver, as if so many frames had said it. */
    static constexpr double kFirstVariance = 4;
    static constexpr int kFirstFrames = 3;

    /** What a frame says, between a tenth and a hundred times the propagated variance: a few odd
     * frames must neither make features certain nor worthless. */
    [[nodiscard]] static double plausible(double variance);

    /** \throws std::invalid_argument naming the key */
    explicit NoiseScale(const TParams& params);

    /** Learns from a measured frame, `dt` [s] after the one before. */
    void update(const PoseAnalysis& analysis, double dt);

    /** For the solver: with the constant factors, by which features are weighed against a predicted
     * motion. */
    [[nodiscard]] NoiseFactors factors() const;

    /** Variance of the residuals so far over the one that factors() starts with, out of caution:
     * that of points, or of planes if there are no points. */
    [[nodiscard]] double overCautious() const;

    /** Variance of the errors of the latest frame over that of a usual one: its scatter
     * (PoseAnalysis) over the geometric mean of those before, which single bad frames hardly move.
     */
    [[nodiscard]] double ofFrame() const { return scatter_.ofFrame; }

    /** The latest frame does not tell its noise: it counts as a usual one. */
    void skip() { scatter_.ofFrame = 1; }

    /** What the points of a frame usually have, for covariances. As geometric means, in which the
     * first guess counts as one frame, these soon forget it: a camera that turns fast in its first
     * frames has residuals of 50 times the propagated variance. */
    struct TypicalPoints
    {
        double residuals;     //!< variance, over the propagated one
        double disagreement;  //!< how much more the references contradict each other
    };
    [[nodiscard]] TypicalPoints typicalPoints() const
    {
        return {pointResiduals_.typical, pointCommon_.typical};
    }

    /** Learnt from the residuals alone. */
    [[nodiscard]] NoiseFactors residuals() const
    {
        return {pointResiduals_.quick, planeResiduals_.quick};
    }

 private:
    /** What single frames say, averaged. */
    struct Average
    {
        double cautious{1};  //!< from the first value on with the time constant, for the solver
        double quick{1};     //!< at first the mean of all frames
        double typical{1};   //!< at first the geometric mean of all frames, for covariances; the
                             //!< first guess counts as one frame
        int numFrames{0};
        void follow(double variance, double dt, double timeConstant);
    };

    struct Scatter
    {
        double usualLog{0}, ofFrame{1};
        int numFrames{0};
        void follow(double scatter, double dt, double timeConstant);
    };

    TParams params_;
    Scatter scatter_;
    Average pointResiduals_, planeResiduals_;  //!< by the residuals alone
    Average pointCommon_, planeCommon_;        //!< over that, by the references' disagreement
};
}  // namespace pointplane
