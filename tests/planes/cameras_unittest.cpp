// SPDX-License-Identifier: BSD-3-Clause
/** Planes of simulated rooms as cameras of each kind see them: found, whole, and as certain as they
 * are. */
#include <pointplane/planes/PlaneExtractor.h>
#include <pointplane/sensor/DepthNoiseLearner.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/core.hpp>

#include <iostream>

#include "linear_algebra.h"
#include "segmentation_score.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kLearnt = 3, kFrames = 8;
constexpr double kTolerance = 0.8;

struct PlanesOfACamera
{
    test::SegmentationScore score;
    double nees{0};  //!< per degree of freedom, mean over planes that are correctly found
    std::string kind;
};

/** Chi-square of the found plane's parameters n/d. */
[[nodiscard]] double chiSquareOf(const PlaneFeature& found, const Plane& truth)
{
    const Eigen::Vector3d error = found.plane_cam.theta_m - minimalForm(truth);
    return test::squaredMahalanobis(error, found.plane_cam.cov_m);
}

/** True planes that one found plane covers, with its label. */
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> correctOnes(
    const TruePlanes& truth, const PlaneSet& found, const cv::Mat& valid)
{
    std::vector<std::pair<std::size_t, std::size_t>> out;
    for (std::size_t t = 0; t < truth.planes_cam.size(); ++t)
    {
        const cv::Mat own = (truth.labels == static_cast<int>(t) + 1) & valid;
        const int size = cv::countNonZero(own);
        for (std::size_t f = 0; size > 0 && f < found.planes.size(); ++f)
        {
            const cv::Mat segment = (found.labels == static_cast<int>(f) + 1) & valid;
            const int common = cv::countNonZero(own & segment);
            if (common >= kTolerance * size && common >= kTolerance * cv::countNonZero(segment))
            {
                out.emplace_back(t, f);
            }
        }
    }
    return out;
}

[[nodiscard]] PlanesOfACamera planesOf(const std::string& camera, const std::string& scene)
{
    SimulationParams params = SimulationParams::of(camera);
    params.exposure = params.readoutDepth = params.depthDelay = 0;  // planes of one instant
    params.duration = 6;
    const SimulatedSequence sequence(scene, params, 1);
    DepthNoiseLearner learner{DepthNoise()};
    PlaneExtractor extractor({}, {});
    PlanesOfACamera out;
    double sum = 0;
    int count = 0;
    for (int i = 0; i < kLearnt; ++i)
    {
        learner.update(sequence.frame(i).depth);
    }
    extractor.setNoise(learner.noise());
    for (int k = 0; k < kFrames; ++k)
    {
        const int i = k * (sequence.numFrames() - 1) / kFrames;
        const RgbdFrame frame = sequence.frame(i);
        const PlaneSet found = extractor.extract(frame.depth, frame.camera);
        const TruePlanes truth = sequence.truePlanes(i);
        const cv::Mat valid = frame.depth > 0;
        const int minPixels = frame.depth.rows * frame.depth.cols / 50;
        out.score +=
            test::scoreSegmentation(truth.labels, found.labels, valid, kTolerance, minPixels);
        for (const auto& [t, f] : correctOnes(truth, found, valid))
        {
            sum += chiSquareOf(found.planes[f], truth.planes_cam[t]) / 3;
            ++count;
        }
    }
    out.nees = sum / std::max(1, count);
    out.kind = learner.noise().kind;
    std::cout << camera << ", " << scene << ": " << out.kind << ", " << describe(learner.noise())
              << "; of " << out.score.numTrue << " planes " << out.score.correct << " found, "
              << out.score.over << " cut, " << out.score.under << " joined, " << out.score.missed
              << " missed; NEES " << out.nees << " of " << count << "\n";
    return out;
}
}  // namespace

struct CameraOfAKind
{
    const char *name, *kind;
};

void PrintTo(const CameraOfAKind& camera, std::ostream* out) { *out << camera.name; }

class PlanesOfCameras : public testing::TestWithParam<CameraOfAKind>
{
};

TEST_P(PlanesOfCameras, areFoundWholeAndAsCertainAsTheyAre)
{
    const CameraOfAKind camera = GetParam();
    for (const char* scene : {"notexture", "corner", "desk"})
    {
        const PlanesOfACamera planes = planesOf(camera.name, scene);
        // A phone bends surfaces by more than what lies on a desk is high: joined, but not cut.
        const bool hidesSteps = std::string(camera.name) == "phone" && std::string(scene) == "desk";
        EXPECT_GE(planes.score.correct, (hidesSteps ? 0.55 : 0.8) * planes.score.numTrue) << scene;
        EXPECT_LE(planes.score.over, 0.05 * planes.score.numTrue) << scene;
        EXPECT_LT(planes.nees, 1.5) << scene;
        EXPECT_GT(planes.nees, 0.05) << scene;
        EXPECT_EQ(planes.kind, camera.kind) << scene;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds,
    PlanesOfCameras,
    testing::Values(
        CameraOfAKind{"kinect", "structuredLight"},
        CameraOfAKind{"d435", "structuredLight"},  // less than twice a Kinect's noise
        CameraOfAKind{"azure", "timeOfFlight"},
        CameraOfAKind{"phone", "timeOfFlight"}),
    [](const auto& camera) { return std::string(camera.param.name); });
}  // namespace pointplane
