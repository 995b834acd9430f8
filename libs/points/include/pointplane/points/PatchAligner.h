// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/points/ImagePyramid.h>

#include <array>
#include <vector>

namespace pointplane
{
/** A patch of the reference image, warped as the current image will show it, with all that the
 * search needs and that depends on it alone. Made by PatchAligner. */
struct PatchReference
{
    static constexpr int kMaxLevels = 6;

    /** One pyramid level. */
    struct Level
    {
        bool isUsable{false};
        float mean{0};        //!< of the template [grey]
        float energy{0};      //!< sum of squares of the zero-mean template [grey^2]
        double noiseGain{1};  //!< noise variance of its samples over that of a pixel
        Eigen::Matrix2d hessian{
            Eigen::Matrix2d::Zero()};  //!< of Gauss-Newton, gain and bias eliminated [grey^2/px^2]
        Eigen::Matrix2d inverse{
            Eigen::Matrix2d::Zero()};  //!< pseudo-inverse over the directions with texture
    };
    std::array<Level, kMaxLevels> levels;
    std::vector<float> data;  //!< of a level: zero-mean template, x gradient, y gradient

    /** False: flat, or too near to the border of the image. */
    [[nodiscard]] bool isUsable() const { return levels[0].isUsable; }
};

enum class AlignStatus
{
    Converged,
    NotConverged,  //!< iterations used up, or the search ran away
    OutOfImage,    //!< the patch left the image
    Dissimilar,    //!< converged, but below minZncc
    Unusable       //!< the reference is flat or was at the border
};

struct AlignResult
{
    AlignStatus status{AlignStatus::Unusable};
    Eigen::Vector2d uv_px{0, 0};  //!< centre of the patch in the current image
    double zncc{0};               //!< zero-mean normalised cross-correlation, 1 = identical
    Eigen::Matrix2d cov{Eigen::Matrix2d::Zero()};  //!< of uv_px [px^2]; positive definite
    int iterations{0};                             //!< over all levels

    [[nodiscard]] bool isConverged() const { return status == AlignStatus::Converged; }
};

/** Finds a patch again with sub-pixel accuracy: inverse-compositional Gauss-Newton (Baker &
 * Matthews 2004) over translation, gain and bias, coarse to fine.
 *
 * With template T, its gradient and the current patch I, I(p + x) ~ a T(x + delta) + b is linear in
 * (a, b, a delta). Gain and bias are eliminated once, by projecting the gradient onto the
 * complement of {1, T}, which leaves two correlations and a 2x2 solve per step.
 *
 * The covariance is sigma^2 H^-1 with sigma^2 estimated from the final residual: pixel noise of
 * both images (their interpolation taken into account), but not errors that a patch has in common,
 * such as motion of an occluding edge. A direction without texture (along an edge) is not searched
 * and has half the patch as its standard deviation. */
class PatchAligner
{
 public:
    struct TParams
    {
        int patchSizePx{8};          //!< 8, 12 or 16
        int numLevels{3};            //!< pyramid levels searched, coarse to fine
        int maxIterations{12};       //!< per level
        double convergencePx{0.01};  //!< a smaller step ends the search
        double noise{2};             //!< [grey levels] sigma of image noise
        double minContrast{3};       //!< [grey levels] standard deviation of a usable patch
        double minZncc{0.7};         //!< similarity below which a patch is not the same

        template <class V>
        void visit(V&& v)
        {
            v("patchSizePx", patchSizePx, "px", "side of the patch: 8, 12 or 16");
            v("numLevels", numLevels, "-", "pyramid levels searched, coarse to fine");
            v("maxIterations", maxIterations, "-", "Gauss-Newton steps per pyramid level");
            v("convergencePx", convergencePx, "px", "a smaller step ends the search");
            v("noise", noise, "grey", "image noise; gradients that it explains are not followed");
            v("minContrast", minContrast, "grey", "least standard deviation of a patch");
            v("minZncc", minZncc, "-", "least zero-mean normalised cross-correlation of a match");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    PatchAligner() : PatchAligner(TParams{}) {}

    /** \throws std::invalid_argument naming the key when a parameter is out of range */
    explicit PatchAligner(const TParams& params);

    [[nodiscard]] const TParams& params() const { return params_; }

    /** \param uv_px centre of the patch in the reference image
     * \param A_ref_cur 2x2, maps offsets from the centre in the current image to offsets in the
     * reference image (identity when the view has not changed)
     * \param out overwritten; its memory is reused. Not usable when flat or at the border. */
    void makeReference(
        const ImagePyramid& reference,
        const Eigen::Vector2d& uv_px,
        const Eigen::Matrix2d& A_ref_cur,
        PatchReference& out) const;

    [[nodiscard]] PatchReference makeReference(
        const ImagePyramid& reference,
        const Eigen::Vector2d& uv_px,
        const Eigen::Matrix2d& A_ref_cur = Eigen::Matrix2d::Identity()) const;

    /** \param start_px where to begin in the current image; within a few pixels times
     * 2^(numLevels - 1) of the answer */
    [[nodiscard]] AlignResult align(
        const PatchReference& reference,
        const ImagePyramid& current,
        const Eigen::Vector2d& start_px) const;

 private:
    TParams params_;
};
}  // namespace pointplane
