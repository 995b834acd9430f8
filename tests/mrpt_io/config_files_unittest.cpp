// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/params_ini.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>
#include <string>

#include "TempDir.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
const std::string kRoot = POINTPLANE_SOURCE_DIR;

/** Few enough to read; the rest comes last. */
TEST(ConfigFiles, atMost45KeysAreNotForExperts)
{
    OdometryParams params;
    const ParameterTable table = parametersOf(params);
    const auto expert = std::find_if(
        table.begin(),
        table.end(),
        [](const ParameterRef& p) { return p.section == OdometryParams::kFirstExpertSection; });
    ASSERT_NE(expert, table.end());
    EXPECT_LE(expert - table.begin(), 45);
    const std::string text = iniText(table, OdometryParams::kFirstExpertSection);
    EXPECT_THAT(text, testing::HasSubstr("# For experts: "));
}

TEST(ConfigFiles, configIniIsTheDumpedDefault)
{
    OdometryParams params;
    EXPECT_EQ(
        test::readBytes(kRoot + "/config.ini"),
        iniText(parametersOf(params), OdometryParams::kFirstExpertSection))
        << "run pointplane-odometry --dump-config > config.ini";
}

/** A key that says what the default says hides the ones that matter. */
TEST(ConfigFiles, theOthersHoldOnlyWhatDiffersFromTheDefaults)
{
    for (const char* const name : {"config-fast.ini", "config-paper.ini"})
    {
        const std::string path = kRoot + "/" + name;
        OdometryParams params = loadOdometryParams(path), defaults;
        const ParameterTable values = parametersOf(params), usual = parametersOf(defaults);
        std::size_t differing = 0;
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            differing += values[i].text() != usual[i].text() ? 1 : 0;
        }
        std::istringstream lines(test::readBytes(path));
        std::size_t written = 0;
        for (std::string line; std::getline(lines, line);)
        {
            const bool isAssignment =
                !line.empty() && std::isalpha(line[0]) != 0 && line.find('=') != std::string::npos;
            written += isAssignment ? 1 : 0;
        }
        EXPECT_GT(written, 0U) << name;
        EXPECT_EQ(written, differing) << name << " repeats a default";
    }
}

/** A value of the paper's configuration, and the place in the paper that asks for it. */
struct PapersValue
{
    const char* where;
    const char* key;
    const char* value;
};

class PapersConfiguration : public testing::TestWithParam<PapersValue>
{
};

TEST_P(PapersConfiguration, hasTheValueThatThePaperNames)
{
    OdometryParams params = loadOdometryParams(kRoot + "/config-paper.ini");
    for (const ParameterRef& parameter : parametersOf(params))
    {
        if (parameter.section + "." + parameter.key == GetParam().key)
        {
            EXPECT_EQ(parameter.text(), GetParam().value) << GetParam().where;
            return;
        }
    }
    FAIL() << "no key " << GetParam().key;
}

const PapersValue kNamed[] = {
    {"Fig. 1: points", "Pipeline.usePoints", "true"},
    {"Fig. 1: and planes", "Pipeline.usePlanes", "true"},
    {"Point Extraction: SURF features", "PointDetector.detector", "surf"},
    {"Point Extraction: SURF has an orientation (Bay 2006)", "PointDetector.upright", "false"},
    {"Point Extraction: sigma_p = 1/2", "DepthNoise.sigmaPixelPx", "0.5"},
    {"Point Extraction: sigma_Z = 1.425e-6 Z^2 [mm]", "DepthNoise.sigmaInverseDepth", "0.001425"},
    {"Point Extraction: sigma_Z has no other part", "DepthNoise.sigmaDepth", "0"},
    {"Point Extraction: sigma_Z has no other part", "DepthNoise.sigmaRelative", "0"},
    {"Eq. 2: sigma_Z of a Kinect", "DepthNoise.kind", "given"},
    {"Eq. 1: the respective depth pixel value", "PointLifter.depthModel", "nearest"},
    {"Eq. 1: whatever is beside it", "PointLifter.maxEdgeSigmas", "0"},
    {"Plane Extraction: RANSAC filters each detected plane", "PlaneExtractor.ransac", "true"},
    {"Plane Extraction: no merging", "PlaneExtractor.mergeCoplanarPlanes", "false"},
    {"after Eq. 3: w = sigma_Z^-2", "PlaneExtractor.fitWeights", "sigmaZ"},
    {"Eq. 3: each pixel counts", "PlaneExtractor.correlatedPixels", "1"},
    {"Matching: descriptors", "Points.method", "match"},
    {"Matching: the closest match", "PointMatcher.maxRatio", "1"},
    {"Matching: of the frame before", "PointMatcher.crossCheck", "false"},
    {"Matching: overlap of at least 50 %", "PlaneMatcher.minOverlap", "0.5"},
    {"Matching: normals within 10 degrees", "PlaneMatcher.maxNormalAngleDeg", "10"},
    {"Matching: distances within 10 cm", "PlaneMatcher.maxDistance", "0.1"},
    {"Matching: the minimum plane-to-plane distance", "PlaneMatcher.secondNearest", "false"},
    {"Matching: small frame-to-frame motion", "Pipeline.searchAround", "previous"},
    {"Matching: consecutive frames", "Reference.reference", "adjacent"},
    {"Matching: one search", "Reference.keyframeMinOverlap", "0"},
    {"Fig. 1: nothing but points and planes tells the motion", "Pipeline.searchImages", "false"},
    {"Fig. 1: all of the image shows the world", "Pipeline.findRobot", "false"},
    {"Eq. 9: plane residual", "PoseSolver.planeResidual", "closestPoint"},
    {"after Eq. 10: w = 1 / diag(Sigma_r)", "PoseSolver.weighting", "diagonal"},
    {"after Eq. 10: planes have no M-estimator", "PoseSolver.planeStudentDof", "0"},
    {"after Eq. 10: uncertainties as propagated", "NoiseScale.adaptive", "false"},
    {"after Eq. 10: uncertainties as propagated", "NoiseScale.pointFactor", "1"},
    {"after Eq. 10: uncertainties as propagated", "NoiseScale.planeFactor", "1"},
    {"Experiments: alpha = 10", "PoseSolver.alpha", "10"},
    {"Pose estimation: or else the decaying velocity", "Pipeline.degeneracy", "gate"},
    {"Pose estimation: the eigenvalue decides alone", "Pipeline.leastAgreement", "0"},
    {"Pose estimation: Sigma = H^-1", "PoseSolver.covariance", "hessian"},
    {"Pose estimation: that of each increment", "Covariance.model", "independent"},
    {"nothing is said of the shutter", "Shutter.correct", "false"},
    {"nothing is said of the calibration", "Lens.selfCalibrate", "false"},
};
INSTANTIATE_TEST_SUITE_P(Paper, PapersConfiguration, testing::ValuesIn(kNamed));

/** What the paper leaves open, and docs/paper_figures.md calls a choice. */
const PapersValue kChosen[] = {
    {"Matching: a k-NN search", "PointMatcher.neighbours", "5"},
    {"Matching: a circular region", "PointMatcher.searchRadiusPx", "50"},
    {"Point Extraction: SURF's threshold", "PointDetector.surfThreshold", "30"},
    {"Point Extraction: how many points", "PointDetector.maxPoints", "500"},
    {"Point Extraction: and where", "PointDetector.gridCellPx", "40"},
    {"Point Extraction: depths that count", "PointLifter.minDepth", "0.02"},
    {"Point Extraction: depths that count", "PointLifter.maxDepth", "100"},
    {"Plane Extraction: cells", "PlaneExtractor.cellSizePx", "10"},
    {"Plane Extraction: least size", "PlaneExtractor.minPlaneFraction", "0.01"},
    {"after Eq. 10: Tukey weights", "PoseSolver.tukeySigmas", "4.685"},
    {"Pose estimation: a decaying velocity", "MotionModel.accelerationTime", "0.05"},
    {"Pose estimation: a given threshold", "Pipeline.gateSigma", "0.5"},
};
INSTANTIATE_TEST_SUITE_P(Choice, PapersConfiguration, testing::ValuesIn(kChosen));

/** No value differs from the default without a reason. */
TEST(ConfigFiles, eachValueOfThePapersConfigurationHasItsPlaceInThePaper)
{
    OdometryParams params = loadOdometryParams(kRoot + "/config-paper.ini"), defaults;
    const ParameterTable values = parametersOf(params), usual = parametersOf(defaults);
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        const std::string key = values[i].section + "." + values[i].key;
        const auto isKey = [&](const PapersValue& value) { return value.key == key; };
        if (values[i].text() != usual[i].text())
        {
            EXPECT_TRUE(
                std::any_of(std::begin(kNamed), std::end(kNamed), isKey) ||
                std::any_of(std::begin(kChosen), std::end(kChosen), isKey))
                << key;
        }
    }
}
}  // namespace
}  // namespace pointplane
