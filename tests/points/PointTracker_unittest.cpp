// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/quantile.h>
#include <pointplane/points/PointTracker.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "texture.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using Eigen::Vector2d;

constexpr double kDepth = 2;  // [m]

/** A wall, square to the camera. \param grey of a pixel */
template <class F>
RgbdFrame wallOf(const F& grey, unsigned noiseSeed)
{
    test::GaussianSampler random(noiseSeed);
    RgbdFrame out;
    out.gray = test::renderImage(640, 480, grey, 1.5, &random);
    out.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(kDepth));
    return out;
}

/** A textured wall, moved by `shift` pixels. */
RgbdFrame wall(const Vector2d& shift_px, unsigned noiseSeed, double coarsestPx = 80)
{
    const test::Texture texture(1, 5, coarsestPx);
    return wallOf(
        [&](double u, double v) { return texture(u - shift_px.x(), v - shift_px.y()); }, noiseSeed);
}

/** Motion of the camera that moves the wall's picture by so much. */
Eigen::Isometry3d motionFor(const Vector2d& shift_px, const PinholeCamera& camera)
{
    Eigen::Isometry3d T_cur_ref = Eigen::Isometry3d::Identity();
    T_cur_ref.translation() << shift_px.x() * kDepth / camera.fx, shift_px.y() * kDepth / camera.fy,
        0;
    return T_cur_ref;
}

struct Errors
{
    Vector2d mean{0, 0};
    double rms{0}, max{0};  // [px]
};

Errors errorsOf(
    const PointReference& reference, const std::vector<PointTrack>& tracks, const Vector2d& shift)
{
    Errors out;
    for (const PointTrack& t : tracks)
    {
        const Vector2d e = t.cur.uv_px - reference.points[static_cast<size_t>(t.ref)].uv_px - shift;
        out.mean += e / static_cast<double>(tracks.size());
        out.rms += e.squaredNorm() / static_cast<double>(tracks.size());
        out.max = std::max(out.max, e.norm());
    }
    out.rms = std::sqrt(out.rms);
    return out;
}

/** Of the tracks' positions in the image, per degree of freedom, against their own covariances. */
double neesOf(
    const PointReference& reference,
    const std::vector<PointTrack>& tracks,
    const Vector2d& shift_px,
    const PinholeCamera& camera)
{
    double sum = 0;
    for (const PointTrack& t : tracks)
    {
        const Eigen::Vector3d& p = t.cur.p_cam.mean;
        Eigen::Matrix<double, 2, 3> J;
        J << camera.fx, 0, -camera.fx * p.x() / p.z(), 0, camera.fy, -camera.fy * p.y() / p.z();
        const Eigen::Matrix2d cov = J * t.cur.p_cam.cov * J.transpose() / (p.z() * p.z());
        const Vector2d e =
            t.cur.uv_px - reference.points[static_cast<size_t>(t.ref)].uv_px - shift_px;
        sum += e.dot(cov.inverse() * e) / 2;
    }
    return sum / static_cast<double>(tracks.size());
}

PointTracker makeTracker(const PointTracker::TParams& params = {})
{
    return PointTracker(params, {}, {});
}

TEST(PointTracker, FindsCornersSpreadOverTheImage)
{
    const RgbdFrame frame = wall({0, 0}, 1);
    const PointReference reference = makeTracker().makeReference(frame);
    EXPECT_EQ(reference.points.size(), 300U);
    std::set<int> ninths;
    for (size_t i = 0; i < reference.points.size(); ++i)
    {
        const Vector2d& a = reference.points[i].uv_px;
        ninths.insert(static_cast<int>(a.x() / 214) + 3 * static_cast<int>(a.y() / 160));
        for (size_t j = 0; j < i; ++j)
        {
            EXPECT_GE((a - reference.points[j].uv_px).norm(), 0.016 * 640 - 1e-6);
        }
    }
    EXPECT_EQ(ninths.size(), 9U);
}

TEST(PointTracker, CornersHaveStructureInBothDirections)
{
    // A chessboard: its crossings are corners, its edges are not.
    RgbdFrame frame = wall({0, 0}, 1);
    constexpr int kSquare = 40;
    for (int v = 0; v < 480; ++v)
    {
        for (int u = 0; u < 640; ++u)
        {
            frame.gray.at<uchar>(v, u) = (u / kSquare + v / kSquare) % 2 == 0 ? 60 : 180;
        }
    }
    PointTracker::TParams params;
    params.cornerQuality = 0.1;
    const PointReference reference = makeTracker(params).makeReference(frame);
    EXPECT_EQ(reference.points.size(), 15U * 11U);
    for (const PointFeature& p : reference.points)
    {
        const Vector2d toCrossing(
            std::remainder(p.uv_px.x() + 0.5, kSquare), std::remainder(p.uv_px.y() + 0.5, kSquare));
        EXPECT_LT(toCrossing.norm(), 3);
    }
}

TEST(PointTracker, RecoversShiftsOfAFractionOfAPixel)
{
    const PointTracker tracker = makeTracker();
    const RgbdFrame first = wall({0, 0}, 1);
    const PointReference reference = tracker.makeReference(first);
    for (const Vector2d& shift : {Vector2d(0.25, 0.5), Vector2d(2.3, -1.6), Vector2d(-6.7, 7.1)})
    {
        const RgbdFrame second = wall(shift, 2);
        const auto tracks = tracker.track(
            reference, second, tracker.pyramid(second.gray), Eigen::Isometry3d::Identity());
        EXPECT_GT(tracks.size(), 0.9 * static_cast<double>(reference.points.size()));
        const Errors errors = errorsOf(reference, tracks, shift);
        EXPECT_LT(errors.mean.norm(), 0.01);
        EXPECT_LT(errors.rms, 0.07);
        EXPECT_LT(errors.max, 0.2);
    }
}

/** But for sigmaPx, which stands for what such images do not have. White noise counts five times:
 * once as the image's, four times as what does not fit in patches, where 2 x 2 px count as one. */
TEST(PointTracker, TracksAreAsExactAsTheySay)
{
    PointTracker::TParams params;
    params.sigmaPx = 0.001;
    const PointTracker tracker = makeTracker(params);
    const PointReference reference = tracker.makeReference(wall({0, 0}, 1));
    const Vector2d shift(2.3, -1.6);
    const RgbdFrame second = wall(shift, 2);
    const auto tracks = tracker.track(
        reference, second, tracker.pyramid(second.gray), Eigen::Isometry3d::Identity());
    const double nees = neesOf(reference, tracks, shift, second.camera);
    EXPECT_NEAR(nees, 1.0 / 5, 0.06);
}

TEST(PointTracker, NarrowSearchKeepsToItsRadius)
{
    const PointTracker tracker = makeTracker();
    const PointReference reference = tracker.makeReference(wall({0, 0}, 1));
    const auto numPoints = static_cast<double>(reference.points.size());
    const Vector2d shift(-28, 21), onward(0.8, -0.6);
    const RgbdFrame second = wall(shift, 2);
    const std::vector<cv::Mat> pyramid = tracker.pyramid(second.gray);
    // By how much the prediction is wrong; the radius is 12.8 px.
    const auto tracksOff = [&](double wrong_px)
    {
        const Eigen::Isometry3d T = motionFor(shift + wrong_px * onward, second.camera);
        return tracker.track(reference, second, pyramid, T);
    };
    EXPECT_GT(static_cast<double>(tracksOff(12.3).size()), 0.8 * numPoints);
    EXPECT_LT(static_cast<double>(tracksOff(13.3).size()), 0.05 * numPoints);
    // With the motion known the same shift is tracked as exactly as a small one.
    const auto predicted = tracksOff(0);
    EXPECT_GT(static_cast<double>(predicted.size()), 0.8 * numPoints);
    EXPECT_LT(errorsOf(reference, predicted, shift).rms, 0.08);
}

TEST(PointTracker, WideSearchFindsLargeErrorsOfThePrediction)
{
    constexpr double kCoarsePx = 300;  // a wide search needs something coarse to hold on to
    const PointTracker tracker = makeTracker();
    const PointReference reference = tracker.makeReference(wall({0, 0}, 1, kCoarsePx));
    const Vector2d shift(-28, 21);
    const RgbdFrame second = wall(shift, 2, kCoarsePx);
    const auto tracks = tracker.track(
        reference, second, tracker.pyramid(second.gray), Eigen::Isometry3d::Identity(), 5);
    int numRight = 0;
    for (const PointTrack& t : tracks)
    {
        const Vector2d& from = reference.points[static_cast<size_t>(t.ref)].uv_px;
        numRight += (t.cur.uv_px - from - shift).norm() < 0.5 ? 1 : 0;
    }
    EXPECT_GT(numRight, 30);
    EXPECT_GT(numRight, 0.8 * static_cast<double>(tracks.size()));
}

/** Something else is in front of the middle. */
class HiddenMiddle
{
 public:
    explicit HiddenMiddle(double minZncc) : tracker_(makeTracker(withZncc(minZncc)))
    {
        const auto isHidden = [&](const PointFeature& p) { return isInside(p); };
        numHidden_ = std::count_if(reference_.points.begin(), reference_.points.end(), isHidden);
    }

    /** Of the points that are hidden, those that are found, by a texture in front of them. */
    std::ptrdiff_t numWrong(unsigned seed)
    {
        const test::Texture other(seed, 5, 80);
        for (int v = kHidden.y; v < kHidden.br().y; ++v)
        {
            for (int u = kHidden.x; u < kHidden.br().x; ++u)
            {
                second_.gray.at<uchar>(v, u) = cv::saturate_cast<uchar>(other(u, v));
            }
        }
        const auto tracks = tracker_.track(
            reference_, second_, tracker_.pyramid(second_.gray), Eigen::Isometry3d::Identity());
        EXPECT_GT(
            static_cast<double>(tracks.size()),
            0.8 * static_cast<double>(reference_.points.size()) - static_cast<double>(numHidden_));
        return std::count_if(
            tracks.begin(),
            tracks.end(),
            [&](const PointTrack& t)
            { return isInside(reference_.points[static_cast<size_t>(t.ref)]); });
    }

    [[nodiscard]] std::ptrdiff_t numHidden() const { return numHidden_; }

 private:
    static PointTracker::TParams withZncc(double minZncc)
    {
        PointTracker::TParams out;
        out.minZncc = minZncc;
        return out;
    }

    inline static const cv::Rect kHidden{200, 140, 240, 200};

    /** With all of its patch. */
    static bool isInside(const PointFeature& p)
    {
        constexpr int kMargin = 8;
        const cv::Rect inner(
            kHidden.x + kMargin,
            kHidden.y + kMargin,
            kHidden.width - 2 * kMargin,
            kHidden.height - 2 * kMargin);
        return inner.contains(cv::Point2d(p.uv_px.x(), p.uv_px.y()));
    }

    PointTracker tracker_;
    PointReference reference_{tracker_.makeReference(wall({0, 0}, 1))};
    RgbdFrame second_{wall({1.5, 0.5}, 2)};
    std::ptrdiff_t numHidden_{0};
};

TEST(PointTracker, RejectsWhatIsHidden)
{
    constexpr unsigned kNumTextures = 16;
    HiddenMiddle hidden(PointTracker::TParams().minZncc), byAnything(0);
    ASSERT_GT(hidden.numHidden(), 15);
    std::ptrdiff_t numWrong = 0;
    for (unsigned k = 0; k < kNumTextures; ++k)
    {
        numWrong += hidden.numWrong(99 + k);
    }
    EXPECT_LE(numWrong, hidden.numHidden() * kNumTextures / 20);
    EXPECT_GT(byAnything.numWrong(99), hidden.numHidden() / 5);
}

TEST(PointTracker, DepthIsWorseAtCornersByAFactor)
{
    PointTracker::TParams as, worse;
    as.depthVarianceFactor = 1;
    worse.depthVarianceFactor = 3;
    const RgbdFrame frame = wall({0, 0}, 1);
    const PointReference a = makeTracker(as).makeReference(frame);
    const PointReference b = makeTracker(worse).makeReference(frame);
    ASSERT_EQ(a.points.size(), b.points.size());
    for (size_t i = 0; i < a.points.size(); ++i)
    {
        const Eigen::Matrix3d &one = a.points[i].p_cam.cov, &three = b.points[i].p_cam.cov;
        EXPECT_NEAR(three(2, 2) / one(2, 2), 3, 1e-6);
    }
}

TEST(PointTracker, BrightnessDoesNotMatter)
{
    const PointTracker tracker = makeTracker();
    const PointReference reference = tracker.makeReference(wall({0, 0}, 1));
    RgbdFrame second = wall({1.5, 0.5}, 2);
    second.gray.convertTo(second.gray, CV_8U, 0.9, 10);
    const auto tracks = tracker.track(
        reference, second, tracker.pyramid(second.gray), Eigen::Isometry3d::Identity());
    EXPECT_GT(tracks.size(), 0.9 * static_cast<double>(reference.points.size()));
    EXPECT_LT(errorsOf(reference, tracks, {1.5, 0.5}).rms, 0.18);
}

/** Exposure does not make a point so much brighter: it is another one. */
TEST(PointTracker, WhatBecomesMuchBrighterIsAnother)
{
    const PointTracker tracker = makeTracker();
    const auto halfAsBright = [](RgbdFrame frame)
    {
        frame.gray.convertTo(frame.gray, CV_8U, 0.5);
        return frame;
    };
    const PointReference reference = tracker.makeReference(halfAsBright(wall({0, 0}, 1)));
    RgbdFrame partlyLit = halfAsBright(wall({1.5, 0.5}, 2));
    const cv::Rect part(0, 0, 200, 480);
    partlyLit.gray(part) += 60;
    const auto tracks = tracker.track(
        reference, partlyLit, tracker.pyramid(partlyLit.gray), Eigen::Isometry3d::Identity());
    EXPECT_GT(tracks.size(), reference.points.size() / 3);
    for (const PointTrack& t : tracks)
    {
        EXPECT_GT(t.cur.uv_px.x(), part.width - 8);
    }
}

TEST(PointTracker, DropsPointsThatLeaveTheImage)
{
    const PointTracker tracker = makeTracker();
    const PointReference reference = tracker.makeReference(wall({0, 0}, 1));
    const Vector2d shift(300, 0);
    const RgbdFrame second = wall(shift, 2);
    size_t numInside = 0;
    for (const PointFeature& p : reference.points)
    {
        numInside += p.uv_px.x() + shift.x() < 631 ? 1 : 0;
    }
    ASSERT_LT(numInside, reference.points.size());
    const auto tracks = tracker.track(
        reference, second, tracker.pyramid(second.gray), motionFor(shift, second.camera));
    EXPECT_LE(tracks.size(), numInside);
    EXPECT_GT(tracks.size(), 0.9 * static_cast<double>(numInside));
    for (const PointTrack& t : tracks)
    {
        EXPECT_LT(t.cur.uv_px.x(), 632);
    }

    // Behind the camera nothing is seen.
    Eigen::Isometry3d past = Eigen::Isometry3d::Identity();
    past.translation().z() = -kDepth - 1;
    EXPECT_TRUE(tracker.track(reference, second, tracker.pyramid(second.gray), past).empty());
}

TEST(PointTracker, ComesInTheReferencesOrderAndIsRepeatable)
{
    const PointTracker tracker = makeTracker();
    const PointReference reference = tracker.makeReference(wall({0, 0}, 1));
    const RgbdFrame second = wall({1.5, 0.5}, 2);
    const auto track = [&]
    {
        return tracker.track(
            reference, second, tracker.pyramid(second.gray), Eigen::Isometry3d::Identity());
    };
    const auto once = track(), again = track();
    ASSERT_EQ(once.size(), again.size());
    for (size_t i = 0; i < once.size(); ++i)
    {
        EXPECT_EQ(once[i].ref, again[i].ref);
        EXPECT_EQ(once[i].cur.uv_px, again[i].cur.uv_px);
        EXPECT_TRUE(i == 0 || once[i - 1].ref < once[i].ref);
    }
}

TEST(PointTracker, HasNothingWithoutPictureTextureOrDepth)
{
    const PointTracker tracker = makeTracker();
    RgbdFrame frame = wall({0, 0}, 1);
    frame.gray = cv::Mat();
    EXPECT_TRUE(tracker.makeReference(frame).points.empty());
    EXPECT_TRUE(tracker.pyramid(frame.gray).empty());

    frame = wall({0, 0}, 1);
    frame.depth.setTo(std::nanf(""));
    EXPECT_TRUE(tracker.makeReference(frame).points.empty());

    frame = wall({0, 0}, 1);
    frame.gray.setTo(128);
    EXPECT_TRUE(tracker.makeReference(frame).points.empty());
}

TEST(PointTracker, BlankWallHasNoCorners)
{
    RgbdFrame frame = wall({0, 0}, 1);
    test::GaussianSampler random(3);
    const auto grey = [](double u, double v) { return 90 + 0.1 * u + 0.05 * v; };
    frame.gray = test::renderImage(640, 480, grey, 1.5, &random);
    EXPECT_TRUE(makeTracker().makeReference(frame).points.empty());

    PointTracker::TParams params;
    params.maxNoisePx = 100;  // corners of noise
    EXPECT_GT(makeTracker(params).makeReference(frame).points.size(), 100U);
}

TEST(PointTracker, OneLevelWorksToo)
{
    PointTracker::TParams params;
    params.numLevels = 1;
    const PointTracker tracker = makeTracker(params);
    const PointReference reference = tracker.makeReference(wall({0, 0}, 1));
    const RgbdFrame second = wall({1.5, 0.5}, 2);
    const auto tracks = tracker.track(
        reference, second, tracker.pyramid(second.gray), Eigen::Isometry3d::Identity());
    EXPECT_GT(tracks.size(), 0.9 * static_cast<double>(reference.points.size()));
    EXPECT_LT(errorsOf(reference, tracks, {1.5, 0.5}).rms, 0.08);
}

TEST(PointTracker, NamesTheParameterThatIsOutOfRange)
{
    PointTracker::TParams params;
    params.windowPx = 3;
    try
    {
        makeTracker(params);
        FAIL() << "no exception";
    }
    catch (const std::invalid_argument& e)
    {
        EXPECT_NE(std::string(e.what()).find("windowPx = 3"), std::string::npos);
    }
}
}  // namespace
/** Three misses, then every eighth frame, each point in its turn. */
TEST(PointTracker, pointsThatAreMissingAreLookedForNowAndThen)
{
    PointReference reference;
    reference.points.resize(2);
    EXPECT_TRUE(reference.isDue(0) && reference.isDue(1));
    int looked[2] = {0, 0}, both = 0;
    for (int frame = 0; frame < 3 + 4 * 8; ++frame)
    {
        looked[0] += reference.isDue(0) ? 1 : 0;
        looked[1] += reference.isDue(1) ? 1 : 0;
        both += frame >= 3 && reference.isDue(0) && reference.isDue(1) ? 1 : 0;
        reference.note({});
    }
    EXPECT_EQ(looked[0], 3 + 4);
    EXPECT_EQ(looked[1], 3 + 4);
    EXPECT_EQ(both, 0);

    PointTrack found;
    found.ref = 1;
    const std::vector<PointTrack> tracks{found};
    reference.note({&tracks});
    EXPECT_TRUE(reference.isDue(1));
    EXPECT_EQ(reference.misses[1], 0);
    EXPECT_GT(reference.misses[0], 3);
}
namespace
{
/** A bright wall ends at a slanted line, and nothing else is to be seen. */
RgbdFrame slantedEdge(double shift_px, unsigned noiseSeed)
{
    return wallOf(
        [&](double u, double v)
        { return 60 + 120 / (1 + std::exp(-(0.8 * (u - shift_px - 320) + 0.6 * (v - 240)))); },
        noiseSeed);
}

/** Motion of a camera that rolls by eight degrees. */
Eigen::Isometry3d roll()
{
    return Eigen::Isometry3d(Eigen::AngleAxisd(0.14, Eigen::Vector3d::UnitZ()));
}

/** Where a pixel was before that. */
Vector2d rolledBack(const Vector2d& uv_px)
{
    const PinholeCamera camera;
    const Eigen::Vector3d ray = camera.normalised(uv_px).homogeneous();
    return camera.project(roll().inverse() * ray);
}
}  // namespace

TEST(PointTracker, EdgesTellTheDirectionAcrossThem)
{
    const PointTracker tracker = makeTracker();
    const PointReference reference = tracker.makeReference(slantedEdge(0, 1));
    ASSERT_GT(reference.points.size(), 5U);
    EXPECT_LE(reference.points.size(), 50U);

    const RgbdFrame frame = slantedEdge(3, 2);
    const auto tracks =
        tracker.track(reference, frame, tracker.pyramid(frame.gray), Eigen::Isometry3d::Identity());
    ASSERT_GT(tracks.size(), 5U);
    const Eigen::Vector3d across(0.8, 0.6, 0), along(-0.6, 0.8, 0);
    for (const PointTrack& t : tracks)
    {
        const PointFeature& ref = reference.points[static_cast<size_t>(t.ref)];
        const Eigen::Vector3d moved = t.cur.p_cam.mean - ref.p_cam.mean;
        const double metrePerPixel = kDepth / frame.camera.fx;
        EXPECT_NEAR(across.dot(moved) / metrePerPixel, 0.8 * 3, 0.3);
        // What each tells of its own, in pixels.
        const Eigen::Matrix3d information =
            metrePerPixel * metrePerPixel * t.cur.p_cam.cov.inverse();
        EXPECT_GT(across.dot(information * across), 1 / (0.4 * 0.4));
        EXPECT_LT(along.dot(information * along), across.dot(information * across) / 1000);
        EXPECT_EQ(t.cur.directions, 1);
    }
    EXPECT_EQ(
        std::count(reference.directions.begin(), reference.directions.end(), 1),
        static_cast<std::ptrdiff_t>(reference.points.size()));
}

TEST(PointTracker, NoiseOfTheFrameIsThatOfItsTracks)
{
    const PointTracker tracker = makeTracker();
    const PointReference reference = tracker.makeReference(wall({0, 0}, 1));
    const auto addedBy = [&](double noise)
    {
        RgbdFrame frame = wall({0, 0}, 2);
        test::GaussianSampler random(3);
        for (auto& grey : cv::Mat_<uchar>(frame.gray))
        {
            grey = cv::saturate_cast<uchar>(grey + noise * random.normal());
        }
        const double metrePerPixel = kDepth / frame.camera.fy;
        std::vector<double> stated;  // across the ray [px^2]
        for (const PointTrack& t : tracker.track(
                 reference, frame, tracker.pyramid(frame.gray), Eigen::Isometry3d::Identity()))
        {
            stated.push_back(t.cur.p_cam.cov(1, 1) / (metrePerPixel * metrePerPixel));
        }
        return stated.empty() ? 0 : *std::min_element(stated.begin(), stated.end());
    };
    // The best track has the frame's noise, and hardly any of its own.
    const double sigma = 0.05, clear = addedBy(0) - sigma * sigma;
    EXPECT_GT(clear, 0);
    // Noise of 6.2 grey levels, not 1.5, in one of two images: nine times the variance.
    const double factor = (addedBy(6) - sigma * sigma) / clear;
    EXPECT_GT(factor, 5);
    EXPECT_LT(factor, 10);
}

/** The camera has rolled: the direction that an edge does not tell has turned with its image. */
TEST(PointTracker, EdgesTurnWithTheCamera)
{
    const PointTracker tracker = makeTracker();
    const PointReference reference = tracker.makeReference(slantedEdge(0, 1));
    const RgbdFrame frame = wallOf(
        [](double u, double v)
        {
            const Vector2d from = rolledBack({u, v});
            return 60 + 120 / (1 + std::exp(-(0.8 * (from.x() - 320) + 0.6 * (from.y() - 240))));
        },
        2);
    const auto tracks = tracker.track(reference, frame, tracker.pyramid(frame.gray), roll());
    ASSERT_GT(tracks.size(), 5U);
    const Eigen::Vector3d across = roll() * Eigen::Vector3d(0.8, 0.6, 0);
    const Eigen::Vector3d along = roll() * Eigen::Vector3d(-0.6, 0.8, 0);
    for (const PointTrack& t : tracks)
    {
        const double metrePerPixel = kDepth / frame.camera.fx;
        const Eigen::Matrix3d information =
            metrePerPixel * metrePerPixel * t.cur.p_cam.cov.inverse();
        EXPECT_LT(along.dot(information * along), across.dot(information * across) / 1000);
    }
}

TEST(PointTracker, FindsCornersOfAnImageThatHasTurned)
{
    const test::Texture texture(1, 5, 80);
    const PointTracker tracker = makeTracker();
    const PointReference reference = tracker.makeReference(wall({0, 0}, 1));
    const RgbdFrame frame = wallOf(
        [&](double u, double v)
        {
            const Vector2d from = rolledBack({u, v});
            return texture(from.x(), from.y());
        },
        2);
    const auto tracks = tracker.track(reference, frame, tracker.pyramid(frame.gray), roll());
    ASSERT_GT(tracks.size(), 100U);
    double sum = 0;
    for (const PointTrack& t : tracks)
    {
        const Vector2d from = rolledBack(t.cur.uv_px);
        sum += (from - reference.points[static_cast<size_t>(t.ref)].uv_px).squaredNorm();
    }
    EXPECT_LT(std::sqrt(sum / static_cast<double>(tracks.size())), 0.12);
}

/** A wall that becomes bright gradually from left to right, by a lens that darkens corners. */
TEST(PointTracker, VignettingDisplacesShadingAsTold)
{
    constexpr double kVignetting = 0.2, kShift_px = 16;
    const auto shaded = [&](double shift_px, unsigned noiseSeed)
    {
        return wallOf(
            [&](double u, double v)
            {
                const double x = u - 319.5, y = v - 239.5;
                const double falloff =
                    1 - kVignetting * (x * x + y * y) / (319.5 * 319.5 + 239.5 * 239.5);
                return falloff * (60 + 150 / (1 + std::exp(-(u - shift_px - 480) / 10)));
            },
            noiseSeed);
    };
    const PointTracker tracker = makeTracker();
    const PointReference reference = tracker.makeReference(shaded(0, 1));
    const RgbdFrame frame = shaded(kShift_px, 2);
    const auto tracks = tracker.track(
        reference, frame, tracker.pyramid(frame.gray), motionFor({kShift_px, 0}, frame.camera));
    ASSERT_GT(tracks.size(), 10U);
    double told = 0, found = 0;
    for (const PointTrack& t : tracks)
    {
        const PointFeature& ref = reference.points[static_cast<size_t>(t.ref)];
        told += kVignetting * t.cur.ofVignetting_m.x() * frame.camera.fx / kDepth;
        found += t.cur.uv_px.x() - ref.uv_px.x() - kShift_px;
    }
    const auto n = static_cast<double>(tracks.size());
    EXPECT_GT(found / n, 0.2) << "darker: to the brighter side";
    EXPECT_NEAR(told / n, found / n, 0.2 * found / n);
}

TEST(PointTracker, EdgesAreLeftOutWhereCornersAbound)
{
    const PointReference reference = makeTracker().makeReference(wall({0, 0}, 1));
    for (const Vector2d& displacement : reference.ofBrightness_px)
    {
        EXPECT_TRUE(displacement.isZero(0)) << "corners are found at any brightness";
    }
    for (const Eigen::Matrix2d& cov : reference.cov_px)
    {
        EXPECT_LT(cov.trace(), 2 * 0.2 * 0.2);
    }
}
}  // namespace pointplane
