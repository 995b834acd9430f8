// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/mrpt_io/RawlogWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationRange.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DInterpolator.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "EvalApp.h"
#include "matchers.h"
#include "mrpt_trajectories.h"
#include "rawlog_samples.h"
#include "run_app.h"
#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace pointplane;
using testing::HasSubstr;

namespace
{
const Trajectory& truth()
{
    static const Trajectory trajectory = randomTrajectory(40, 1);
    return trajectory;
}
const Trajectory& estimate()
{
    static const Trajectory trajectory = odometry(truth(), 2);
    return trajectory;
}

PoseGaussian gaussianAt(std::size_t k) { return {estimate().poses[k], estimate().covs[k]}; }

mrpt::obs::CObservationRobotPose observationOf(std::size_t k, const std::string& label)
{
    mrpt::obs::CObservationRobotPose observation;
    observation.sensorLabel = label;
    observation.timestamp = fromSeconds(estimate().stamps[k]);
    observation.pose = toMrpt(gaussianAt(k));
    return observation;
}

void writeFormat2(const std::string& path, const std::vector<std::string>& labels)
{
    RawlogWriter writer(path);
    for (std::size_t k = 0; k < estimate().size(); ++k)
    {
        for (const std::string& label : labels)
        {
            writer.write(observationOf(k, label));
        }
    }
    writer.close();
}

mrpt::obs::CSensoryFrame frameAt(std::size_t k)
{
    const auto comment = mrpt::obs::CObservationComment::Create();
    comment->timestamp = fromSeconds(estimate().stamps[k]);
    const auto unstamped = mrpt::obs::CObservationComment::Create();
    unstamped->timestamp = INVALID_TIMESTAMP;
    mrpt::obs::CSensoryFrame frame;
    frame.insert(unstamped);
    frame.insert(comment);
    return frame;
}

void expectEstimate(const Trajectory& read)
{
    ASSERT_EQ(read.size(), estimate().size());
    ASSERT_EQ(read.covs.size(), estimate().size());
    for (std::size_t k = 0; k < read.size(); ++k)
    {
        EXPECT_NEAR(read.stamps[k], estimate().stamps[k], 2e-7);
        EXPECT_THAT(read.poses[k], test::IsNearPose(estimate().poses[k], 1e-9, 1e-9));
        const double scale = 1e-9 + 1e-6 * estimate().covs[k].norm();
        EXPECT_THAT(read.covs[k], test::IsMatrixNear(estimate().covs[k], scale)) << k;
    }
}

template <class F>
std::string messageOf(F&& f)
{
    try
    {
        (void)f();
    }
    catch (const std::exception& e)
    {
        return e.what();
    }
    return "no exception";
}

test::AppRun evaluate(const std::vector<std::string>& args) { return test::runApp(runEval, args); }

std::string writeTruth(const test::TempDir& dir)
{
    std::ostringstream text;
    text.precision(15);
    for (std::size_t k = 0; k < truth().size(); ++k)
    {
        const Eigen::Quaterniond q(truth().poses[k].linear());
        text << truth().stamps[k] << " " << truth().poses[k].translation().transpose() << " "
             << q.coeffs().transpose() << "\n";
    }
    return writeFile(dir, "truth.txt", text.str());
}
}  // namespace

TEST(MrptTrajectories, rawlogOfRobotPosesWithTheirCovariances)
{
    test::TempDir dir;
    writeFormat2(dir / "a.rawlog", {"VO"});
    expectEstimate(readRawlogTrajectory(dir / "a.rawlog", ""));
    expectEstimate(readRawlogTrajectory(dir / "a.rawlog", "VO"));
}

TEST(MrptTrajectories, posesWithoutAStampAreLeftOut)
{
    test::TempDir dir;
    {
        RawlogWriter writer(dir / "a.rawlog");
        auto unstamped = observationOf(0, "RGBD_pose");
        unstamped.timestamp = INVALID_TIMESTAMP;
        writer.write(unstamped);
        mrpt::obs::CObservationComment mark;
        mark.text = "pointplane-status label=RGBD frame=0 lost: has no time stamp";
        writer.write(mark);
        for (std::size_t k = 0; k < estimate().size(); ++k)
        {
            writer.write(observationOf(k, "RGBD_pose"));
        }
        writer.write(unstamped);  // of another program, which does not mark it
        writer.close();
    }
    const Trajectory read = readRawlogTrajectory(dir / "a.rawlog", "");
    expectEstimate(read);
    EXPECT_EQ(read.lostWithoutTime, 1U);
    EXPECT_THAT(
        read.warnings,
        testing::Contains(HasSubstr("a.rawlog: 1 pose without a time stamp left out")));
}

TEST(MrptTrajectories, motionsSinceEarlierFramesBelongToTheirPoses)
{
    test::TempDir dir;
    {
        RawlogWriter writer(dir / "a.rawlog");
        for (std::size_t k = 0; k < estimate().size(); ++k)
        {
            writer.write(observationOf(k, "RGBD_pose"));
            for (std::size_t n = 1; n <= std::min<std::size_t>(k, 3); ++n)
            {
                auto since = observationOf(k, "RGBD_since_" + std::to_string(n));
                since.pose = toMrpt(gaussianAt(n));
                writer.write(since);
            }
        }
        writer.close();
    }
    const Trajectory read = readRawlogTrajectory(dir / "a.rawlog", "");
    expectEstimate(read);
    ASSERT_EQ(read.sinceCovs.size(), read.size());
    EXPECT_TRUE(read.sinceCovs[0].empty());
    ASSERT_EQ(read.sinceCovs[2].size(), 2U);
    ASSERT_EQ(read.sinceCovs[20].size(), 3U);
    for (std::size_t n = 1; n <= 3; ++n)
    {
        const Matrix6d& expected = estimate().covs[n];
        EXPECT_THAT(
            read.sinceCovs[20][n - 1], test::IsMatrixNear(expected, 1e-9 + 1e-6 * expected.norm()));
    }
}

namespace
{
/** Three of its frames repeat a stamp, so the odometry lost them. Covariances of poses do not grow
 * after the first. \param numSince motions that are told for each frame */
void writeRepeatedStamps(const std::string& path, std::size_t numSince)
{
    RawlogWriter writer(path);
    std::size_t frame = 0;
    const auto writeFrame = [&](std::size_t k)
    {
        auto pose = observationOf(k, "RGBD_pose");
        pose.pose = toMrpt({estimate().poses[k], estimate().covs[k == 0 ? 0 : 39]});
        writer.write(pose);
        for (std::size_t n = 1; n <= std::min(frame, numSince); ++n)
        {
            auto since = observationOf(k, "RGBD_since_" + std::to_string(n));
            since.pose = toMrpt(gaussianAt(n));
            writer.write(since);
        }
        ++frame;
    };
    for (std::size_t k = 0; k < estimate().size(); ++k)
    {
        writeFrame(k);
        for (int repeated = 0; k == 20 && repeated < 3; ++repeated)
        {
            writeFrame(k);
            mrpt::obs::CObservationComment mark;
            mark.text =
                "pointplane-status label=RGBD frame=" + std::to_string(frame) + " lost: late";
            writer.write(mark);
        }
    }
    writer.close();
}
}  // namespace

/** All increments were taken for untold, and the advice was --since 1. */
TEST(MrptTrajectories, motionsSinceEarlierFramesCountLostFramesWithoutATime)
{
    test::TempDir dir;
    const std::string path = dir / "a.rawlog", truthFile = writeTruth(dir);
    writeRepeatedStamps(path, 5);
    const Trajectory read = readRawlogTrajectory(path, "");
    ASSERT_EQ(read.size(), 40U);
    EXPECT_EQ(read.lostWithoutTime, 3U);
    EXPECT_THAT(read.poses[20], test::IsNearPose(estimate().poses[20], 1e-9, 1e-9));
    EXPECT_THAT(
        read.warnings,
        testing::ElementsAre(
            path + ": 3 lost frames without a pose, as the stamp is not after the one "
                   "before"));
    EXPECT_THAT(incrementCovariance(read, 19, 20), test::IsMatrixNear(estimate().covs[1], 1e-9));
    EXPECT_THAT(incrementCovariance(read, 20, 21), test::IsMatrixNear(estimate().covs[4], 1e-9));
    EXPECT_THAT(incrementCovariance(read, 24, 25), test::IsMatrixNear(estimate().covs[1], 1e-9));
    const test::AppRun told = evaluate({"nees", truthFile, path, "--interval", "1f"});
    EXPECT_THAT(told.out, HasSubstr("increments of 1f: 39"));
    EXPECT_THAT(told.out, HasSubstr("40 frames tracked, 0 predicted, 3 lost"));

    writeRepeatedStamps(path, 3);
    EXPECT_THAT(
        evaluate({"nees", truthFile, path, "--interval", "1f"}).err,
        HasSubstr("Write them by pointplane-odometry --since 4."));
}

/** Where the camera was at that time, the pose of a lost frame does not tell. */
TEST(MrptTrajectories, lateFramesHaveNoPose)
{
    std::vector<StampedPose> poses(4);
    poses[1].stamp = 2;
    poses[2].stamp = 1;
    poses[2].status = FrameStatus::Lost;
    poses[3].stamp = 3;
    EXPECT_THAT(makeTrajectory("late", poses).stamps, testing::ElementsAre(0, 2, 3));
}

TEST(MrptTrajectories, rawlogOfActionsAndFramesIsComposed)
{
    test::TempDir dir;
    {
        RawlogWriter writer(dir / "a.rawlog");
        for (std::size_t k = 0; k < estimate().size(); ++k)
        {
            mrpt::obs::CActionRobotMovement3D movement;
            PoseGaussian step;
            if (k > 0)
            {
                step = {estimate().poses[k - 1].inverse() * estimate().poses[k], incrementCov()};
            }
            movement.poseChange = toMrpt(step);
            mrpt::obs::CActionCollection actions;
            actions.insert(movement);
            writer.write(actions);
            writer.write(frameAt(k));
        }
        writer.close();
    }
    expectEstimate(readRawlogTrajectory(dir / "a.rawlog", ""));
}

TEST(MrptTrajectories, simplemap)
{
    test::TempDir dir;
    mrpt::maps::CSimpleMap map;
    for (std::size_t k = 0; k < estimate().size(); ++k)
    {
        map.insert(
            mrpt::poses::CPose3DPDFGaussian::Create(toMrpt(gaussianAt(k))),
            mrpt::obs::CSensoryFrame::Create(frameAt(k)));
    }
    ASSERT_TRUE(map.saveToFile(dir / "a.simplemap"));
    expectEstimate(readSimplemapTrajectory(dir / "a.simplemap"));

    const std::string plain = test::decompressed(dir / "a.simplemap");
    test::writeBytes(dir / "plain.simplemap", plain);
    expectEstimate(readSimplemapTrajectory(dir / "plain.simplemap"));
    test::writeBytes(dir / "long.simplemap", plain + "more");
    EXPECT_THAT(
        messageOf([&] { return readSimplemapTrajectory(dir / "long.simplemap"); }),
        HasSubstr("long.simplemap: damaged at byte"));

    std::filesystem::resize_file(
        dir / "a.simplemap", std::filesystem::file_size(dir / "a.simplemap") / 2);
    EXPECT_THAT(
        messageOf([&] { return readSimplemapTrajectory(dir / "a.simplemap"); }),
        HasSubstr("a.simplemap: truncated at byte"));
    EXPECT_THAT(
        messageOf([&] { return readSimplemapTrajectory(dir / "none.simplemap"); }),
        HasSubstr("none.simplemap: No such file"));
    writeFormat2(dir / "rawlog.simplemap", {"VO"});
    EXPECT_THAT(
        messageOf([&] { return readSimplemapTrajectory(dir / "rawlog.simplemap"); }),
        HasSubstr("rawlog.simplemap: begins with class CObservationRobotPose, not CSimpleMap"));
}

namespace
{
/** Two key frames with all that an RGB-D camera and other sensors give. */
mrpt::maps::CSimpleMap mapOf(const mrpt::obs::CObservation::Ptr& more)
{
    mrpt::maps::CSimpleMap map;
    for (int k = 0; k < 2; ++k)
    {
        auto frame = mrpt::obs::CSensoryFrame::Create();
        frame->insert(test::sampleScan(k));
        frame->insert(more);
        const auto at = static_cast<std::size_t>(k);
        map.insert(mrpt::poses::CPose3DPDFGaussian::Create(toMrpt(gaussianAt(at))), frame);
    }
    return map;
}
}  // namespace

/** MRPT's own reader ends the process, or takes gigabytes. */
TEST(MrptTrajectories, noByteOfASimplemapCrashesTheReader)
{
    test::TempDir dir;
    const auto comment = mrpt::obs::CObservationComment::Create();
    ASSERT_TRUE(mapOf(comment).saveToFile(dir / "a.simplemap"));
    const std::string bytes = test::decompressed(dir / "a.simplemap");
    EXPECT_EQ(readSimplemapTrajectory(dir / "a.simplemap").size(), 2U);
    std::size_t numRefused = 0;
    for (std::size_t at = 0; at < bytes.size(); ++at)
    {
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(~damaged[at]);
        test::writeBytes(dir / "b.simplemap", damaged);
        const std::string message =
            messageOf([&] { return readSimplemapTrajectory(dir / "b.simplemap"); });
        numRefused += message == "no exception" ? 0 : 1;
    }
    EXPECT_GT(numRefused, 300U);  // the others are pixels, stamps and poses
}

TEST(MrptTrajectories, aDamagedSimplemapIsBadInputThatSaysWhere)
{
    test::TempDir dir;
    const auto comment = mrpt::obs::CObservationComment::Create();
    ASSERT_TRUE(mapOf(comment).saveToFile(dir / "a.simplemap"));
    std::string bytes = test::readBytes(dir / "a.simplemap");
    bytes[bytes.size() - 6] = static_cast<char>(~bytes[bytes.size() - 6]);  // of the checksum
    test::writeBytes(dir / "sum.simplemap", bytes);
    const test::AppRun r = evaluate({"ate", writeTruth(dir), dir / "sum.simplemap"});
    EXPECT_EQ(r.code, 2);
    EXPECT_THAT(r.err, HasSubstr("sum.simplemap: damaged at byte"));
    EXPECT_EQ(r.out, "");
}

/** What only MRPT can read is left to it where a checksum is right. */
TEST(MrptTrajectories, simplemapWithSensorsThatOnlyMrptKnows)
{
    test::TempDir dir;
    ASSERT_TRUE(mapOf(mrpt::obs::CObservationRange::Create()).saveToFile(dir / "a.simplemap"));
    EXPECT_EQ(readSimplemapTrajectory(dir / "a.simplemap").size(), 2U);
    test::writeBytes(dir / "plain.simplemap", test::decompressed(dir / "a.simplemap"));
    EXPECT_THAT(
        messageOf([&] { return readSimplemapTrajectory(dir / "plain.simplemap"); }),
        testing::AllOf(HasSubstr("class CObservationRange"), HasSubstr("no checksum")));
    for (const char* name : {"localization_demo", "malaga-cs-fac-building"})
    {
        const std::string sample =
            std::string("/usr/share/mrpt/datasets/") + name + ".simplemap.gz";
        if (std::filesystem::exists(sample))
        {
            EXPECT_GT(readSimplemapTrajectory(sample).size(), 10U) << name;
        }
    }
}

/** As newer releases of MRPT write it, whose maps Debian 12's cannot read. */
TEST(MrptTrajectories, simplemapWithTwists)
{
    test::TempDir dir;
    {
        mrpt::io::CFileOutputStream file(dir / "twists.simplemap");
        auto archive = mrpt::serialization::archiveFrom(file);
        const std::string name = "mrpt::maps::CSimpleMap";
        archive << static_cast<std::uint8_t>(name.size() | 0x80U);
        archive.WriteBuffer(name.data(), name.size());
        archive << std::uint8_t{2} << std::uint32_t{2};
        for (std::size_t k = 0; k < 2; ++k)
        {
            archive << toMrpt(gaussianAt(k)) << frameAt(k) << std::string("std::optional")
                    << std::string("mrpt::math::TTwist3D") << (k == 1);
            for (int n = 0; k == 1 && n < 6; ++n)
            {
                archive << 0.5;
            }
        }
        archive << std::uint8_t{0x88};
    }
    const Trajectory read = readSimplemapTrajectory(dir / "twists.simplemap");
    ASSERT_EQ(read.size(), 2U);
    EXPECT_THAT(read.poses[1], test::IsNearPose(estimate().poses[1], 1e-9, 1e-9));
}

TEST(MrptTrajectories, posesThatAreNoNumbersAreLeftOutAsInText)
{
    test::TempDir dir;
    const auto write = [&](const std::string& name, double x)
    {
        RawlogWriter writer(dir / name);
        for (std::size_t k = 0; k < estimate().size(); ++k)
        {
            auto observation = observationOf(k, "VO");
            if (k == 5)
            {
                observation.pose.mean.x(x);
            }
            writer.write(observation);
        }
        writer.close();
    };
    write("nan.rawlog", NAN);
    const std::string warning =
        "nan.rawlog: 1 pose with NaN or infinity left out, the first at 100.500000 s";
    for (const char* command : {"rpe", "ate", "compare", "nees"})
    {
        const test::AppRun r = evaluate({command, writeTruth(dir), dir / "nan.rawlog"});
        EXPECT_EQ(r.code, 0) << command << r.err;
        EXPECT_THAT(r.err, HasSubstr(warning)) << command;
    }
    write("far.rawlog", 3e8);
    for (const char* command : {"rpe", "ate", "compare", "nees"})
    {
        const test::AppRun r = evaluate({command, writeTruth(dir), dir / "far.rawlog"});
        EXPECT_EQ(r.code, 2) << command;
        EXPECT_THAT(
            r.err,
            testing::AllOf(HasSubstr("far.rawlog"), HasSubstr("at 100.500000 s is 3e+08 m")));
    }
}

/** In 300 digits, they would hide the rest of the table. */
TEST(MrptTrajectories, numbersThatAreTooLongAreInScientificForm)
{
    test::TempDir dir;
    {
        RawlogWriter writer(dir / "sure.rawlog");
        for (std::size_t k = 0; k < estimate().size(); ++k)
        {
            auto observation = observationOf(k, "RGBD_pose");
            observation.pose.cov *= 1e-200;
            writer.write(observation);
        }
        writer.close();
    }
    const test::AppRun r = evaluate(
        {"nees", writeTruth(dir), dir / "sure.rawlog", "--max-nees", "2", "--report", dir / "r"});
    EXPECT_EQ(r.code, 1) << r.err;
    const std::string digits = "[0-9]{20}";
    EXPECT_THAT(
        r.out, testing::AllOf(HasSubstr("e+"), testing::Not(testing::ContainsRegex(digits))));
    EXPECT_THAT(r.err, testing::Not(testing::ContainsRegex(digits)));
    const std::string html = test::readBytes(dir / "r/index.html");
    EXPECT_THAT(
        html.substr(html.find("<table")), testing::Not(testing::ContainsRegex(digits + "[.]")));
}

/** NaN is neither above a limit nor below one. */
TEST(MrptTrajectories, aNeesThatIsNotFinitePassesNoGate)
{
    test::TempDir dir;
    {
        RawlogWriter writer(dir / "sure.rawlog");
        for (std::size_t k = 0; k < estimate().size(); ++k)
        {
            auto observation = observationOf(k, "RGBD_pose");
            observation.pose.cov *= 1e-305;
            writer.write(observation);
        }
        writer.close();
    }
    const std::string truthFile = writeTruth(dir);
    std::vector<std::string> args{"nees", truthFile, dir / "sure.rawlog", "--interval", "1f"};
    args.insert(args.end(), {"--report", dir / "r"});
    EXPECT_EQ(evaluate(args).code, 0);
    EXPECT_THAT(evaluate(args).out, HasSubstr("verdict: cannot be judged: NEES is not finite"));
    EXPECT_THAT(
        test::readBytes(dir / "r/index.html"),
        HasSubstr("<td class=\"text\">cannot be judged</td>"));
    for (const auto& [option, limit] : {std::pair("--max-nees", "2"), {"--min-nees", "0.5"}})
    {
        args.resize(5);
        args.insert(args.end(), {option, limit});
        EXPECT_EQ(evaluate(args).code, 1) << option;
        EXPECT_THAT(evaluate(args).err, HasSubstr("is outside the stated range"));
    }
    writeFormat2(dir / "a.rawlog", {"VO"});
    for (const auto& [option, sigma] :
         {std::pair("--gt-sigma-trans", "1e154"), {"--gt-sigma-rot-deg", "1e154"}})
    {
        const test::AppRun r = evaluate({"nees", truthFile, dir / "a.rawlog", option, sigma});
        EXPECT_EQ(r.code, 2) << option;
        EXPECT_THAT(r.err, testing::AllOf(HasSubstr(option), HasSubstr("1e154"))) << option;
    }
}

TEST(MrptTrajectories, interpolatorTextAsMrptWritesIt)
{
    test::TempDir dir;
    mrpt::poses::CPose3DInterpolator path;
    for (std::size_t k = 0; k < truth().size(); ++k)
    {
        path.insert(fromSeconds(truth().stamps[k]), toMrpt(truth().poses[k]));
    }
    ASSERT_TRUE(path.saveToTextFile(dir / "path.txt"));
    const test::AppRun r =
        evaluate({"rpe", writeTruth(dir), dir / "path.txt", "--fixed-delta", "--csv", "-"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("translation,m,29,"));
    const test::AppRun gate =
        evaluate({"rpe", dir / "path.txt", writeTruth(dir), "--fixed-delta", "--max-rmse", "1e-5"});
    EXPECT_EQ(gate.code, 0) << gate.out;
}

TEST(MrptTrajectories, labelsHaveToBeClear)
{
    test::TempDir dir;
    writeFormat2(dir / "a.rawlog", {"VO", "WHEELS"});
    expectEstimate(readRawlogTrajectory(dir / "a.rawlog", "VO"));
    EXPECT_THAT(
        messageOf([&] { return readRawlogTrajectory(dir / "a.rawlog", ""); }),
        testing::AllOf(HasSubstr("'VO', 'WHEELS'"), HasSubstr("--sensor-label")));
    EXPECT_THAT(
        messageOf([&] { return readRawlogTrajectory(dir / "a.rawlog", "X"); }),
        HasSubstr("no poses with sensor label 'X', only 'VO', 'WHEELS'"));
    {
        RawlogWriter writer(dir / "empty.rawlog");
        writer.write(frameAt(0));
        writer.close();
    }
    EXPECT_THAT(
        messageOf([&] { return readRawlogTrajectory(dir / "empty.rawlog", ""); }),
        HasSubstr("holds no poses"));
}

TEST(MrptTrajectories, aDamagedRawlogIsScoredUpToTheDamageAndSaysSo)
{
    test::TempDir dir;
    writeFormat2(dir / "a.rawlog", {"VO"});
    std::filesystem::resize_file(
        dir / "a.rawlog", std::filesystem::file_size(dir / "a.rawlog") * 3 / 4);
    const test::AppRun r = evaluate({"rpe", writeTruth(dir), dir / "a.rawlog", "--fixed-delta"});
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, testing::AllOf(HasSubstr("a.rawlog"), HasSubstr("only what comes before")));
    EXPECT_THAT(r.out, HasSubstr("translation"));
}

/** Poses may be behind the damage. */
TEST(MrptTrajectories, aDamagedRawlogWithoutPosesTellsTheDamage)
{
    test::TempDir dir;
    const std::string path = dir / "a.rawlog";
    RawlogWriter writer(path);
    for (int k = 0; k < 4; ++k)
    {
        writer.write(frameAt(k));
    }
    writer.close();
    std::filesystem::resize_file(path, std::filesystem::file_size(path) * 3 / 4);
    EXPECT_THAT(
        messageOf([&] { return readRawlogTrajectory(path, ""); }),
        testing::AllOf(HasSubstr("holds no poses"), HasSubstr("a.rawlog: truncated")));
}

TEST(MrptTrajectories, neesEndToEnd)
{
    test::TempDir dir;
    writeFormat2(dir / "a.rawlog", {"VO"});
    const std::string truthFile = writeTruth(dir);
    const test::AppRun r =
        evaluate({"nees", truthFile, dir / "a.rawlog", "--interval", "1f,5f", "--max-nees", "1.5"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("increments of 5f: 35, 7 without overlap"));
    EXPECT_THAT(r.out, HasSubstr("verdict: consistent"));
    EXPECT_EQ(evaluate({"nees", truthFile, dir / "a.rawlog", "--min-nees", "5"}).code, 1);

    writeFormat2(dir / "b.rawlog", {"VO"});
    const test::AppRun pooled = evaluate(
        {"nees",
         truthFile,
         dir / "a.rawlog",
         truthFile,
         dir / "b.rawlog",
         "--interval",
         "1f",
         "--csv",
         "-"});
    EXPECT_THAT(pooled.out, HasSubstr("\n1f,78,78,joint,"));
    EXPECT_EQ(evaluate({"nees", truthFile, truthFile}).code, 2);  // no covariances
    EXPECT_EQ(evaluate({"nees", truthFile, dir / "a.rawlog", truthFile}).code, 2);
    EXPECT_EQ(evaluate({"nees", truthFile, dir / "a.rawlog", "--interval", "3m"}).code, 2);
}

TEST(MrptTrajectories, neesOfAShortRecordingLeavesOutWhatItIsTooShortFor)
{
    test::TempDir dir;
    const std::string truthFile = writeTruth(dir);
    const auto write = [&](std::size_t count)
    {
        RawlogWriter writer(dir / "short.rawlog");
        for (std::size_t k = 0; k < count; ++k)
        {
            writer.write(observationOf(k, "RGBD_pose"));
        }
        writer.close();
    };
    std::vector<std::string> args{"nees", truthFile, dir / "short.rawlog", "--report", dir / "r"};
    const std::string problem = "only one increment of 10f has ground truth at both ends";
    write(11);  // 1 s
    const test::AppRun r = evaluate(args);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.err, HasSubstr("note: left out: " + problem));
    EXPECT_THAT(r.out, HasSubstr("increments of 1f: 10,"));
    EXPECT_THAT(r.out, testing::Not(HasSubstr("of 10f")));
    const std::string page = test::readBytes(dir / "r/index.html");
    EXPECT_THAT(page, HasSubstr("left out: " + problem));
    EXPECT_LT(page.find("NEES per degree of freedom"), page.find("Relative pose error"));
    EXPECT_THAT(page, testing::Not(HasSubstr("No NEES")));

    // A limit is not passed by an interval that was not tested.
    std::vector<std::string> limited = args;
    limited.insert(limited.end(), {"--max-nees", "1000"});
    EXPECT_EQ(evaluate(limited).code, 2);

    args.insert(args.end(), {"--interval", "10f,1f"});
    const test::AppRun chosen = evaluate(args);
    EXPECT_EQ(chosen.code, 2);
    EXPECT_THAT(chosen.err, HasSubstr("pointplane-eval: " + problem));
    args.resize(5);
    write(2);
    const test::AppRun none = evaluate(args);
    EXPECT_EQ(none.code, 2);
    EXPECT_THAT(none.err, HasSubstr("pointplane-eval: only one increment of 1f"));
}

TEST(MrptTrajectories, neesStatesTheNoiseOfTheGroundTruth)
{
    test::TempDir dir;
    writeFormat2(dir / "a.rawlog", {"VO"});
    const std::string truth = writeTruth(dir);
    const auto nees = [&](const std::string& sigma, const std::string& json)
    {
        return evaluate(
            {"nees", truth, dir / "a.rawlog", "--gt-sigma-rot-deg", sigma, "--json", json});
    };
    EXPECT_THAT(nees("0.5", dir / "a.json").out, HasSubstr("and 0.5 deg per axis and pose"));
    EXPECT_EQ(nees("0.5,0.5,0.5", "-").out, nees("0.5", "-").out);
    const std::string report = nees("0.9,0.5,0", "-").out;
    EXPECT_THAT(report, HasSubstr("and 0.9, 0.5, 0 deg about x, y, z per pose"));
    const auto json = nlohmann::json::parse(report);
    EXPECT_NEAR(json["truthSigmaRotation"][1], 0.5 * M_PI / 180, 1e-12);
    for (const char* bad : {"", "x", "-1", "1,2", "1,2,3,4", "1,2,", "1 2 3", "1,2,x", "nan"})
    {
        const test::AppRun r = nees(bad, "-");
        EXPECT_EQ(r.code, 2) << bad;
        EXPECT_THAT(r.err, HasSubstr("--gt-sigma-rot-deg")) << bad;
    }
}

TEST(MrptTrajectories, opticalGroundTruthOfAnEstimateInMrptAxes)
{
    test::TempDir dir;
    writeFormat2(dir / "a.rawlog", {"VO"});
    std::ostringstream text;
    text.precision(15);
    for (std::size_t k = 0; k < truth().size(); ++k)
    {
        const Eigen::Isometry3d T = truth().poses[k] * opticalInBody();
        text << truth().stamps[k] << " " << T.translation().transpose() << " "
             << Eigen::Quaterniond(T.linear()).coeffs().transpose() << "\n";
    }
    const std::string optical = writeFile(dir, "optical.txt", text.str());
    const auto rmse = [&](const std::string& gt, const std::vector<std::string>& more)
    {
        std::vector<std::string> args{"rpe", gt, dir / "a.rawlog", "--fixed-delta", "--verbose"};
        args.insert(args.end(), more.begin(), more.end());
        return evaluate(args).out;
    };
    EXPECT_EQ(rmse(optical, {"--body-from-gt", "optical"}), rmse(writeTruth(dir), {}));
    EXPECT_EQ(rmse(optical, {"--body-from-gt=0,0,0,-90,0,-90"}), rmse(writeTruth(dir), {}));
    EXPECT_NE(rmse(optical, {}), rmse(writeTruth(dir), {}));
    EXPECT_EQ(
        evaluate({"rpe", optical, dir / "a.rawlog", "--body-from-gt", "0,0,0,1"}).code,
        kExitBadInput);
    EXPECT_THAT(
        evaluate({"rpe", optical, dir / "a.rawlog", "--fixed-delta"}).err,
        HasSubstr("hint: with --body-from-gt optical"));
    EXPECT_EQ(evaluate({"rpe", writeTruth(dir), dir / "a.rawlog", "--fixed-delta"}).err, "");
}

namespace
{
/** As pointplane-odometry writes it: poses, motions since the frame before, and marks. */
void writeOdometry(
    const std::string& path,
    bool withSince,
    const Eigen::Isometry3d& body,
    const std::string& camera = "RGBD")
{
    RawlogWriter writer(path);
    for (std::size_t k = 0; k < estimate().size(); ++k)
    {
        auto observation = observationOf(k, camera + "_pose");
        PoseGaussian pose = gaussianAt(k);
        pose.mean = pose.mean * body;
        observation.pose = toMrpt(pose);
        writer.write(observation);
        if (withSince && k > 0)
        {
            auto since = observationOf(k, camera + "_since_1");
            since.pose = toMrpt({Eigen::Isometry3d::Identity(), incrementCov()});
            writer.write(since);
        }
        if (k >= 10 && k < 30)
        {
            mrpt::obs::CObservationComment comment;
            comment.timestamp = observation.timestamp;
            comment.text = "pointplane-status label=" + camera + " frame=" + std::to_string(k) +
                           (k < 20 ? " lost: no depth" : " predicted: no matches");
            writer.write(comment);
        }
    }
    writer.close();
}
}  // namespace

TEST(MrptTrajectories, marksOfLostFramesInARawlogAreReadAndSaid)
{
    test::TempDir dir;
    writeOdometry(dir / "a.rawlog", true, Eigen::Isometry3d::Identity());
    const Trajectory read = readRawlogTrajectory(dir / "a.rawlog", "");
    EXPECT_TRUE(read.marksFrames);
    ASSERT_EQ(read.status.size(), 40u);
    EXPECT_EQ(read.status[9], FrameStatus::Tracked);
    EXPECT_EQ(read.status[10], FrameStatus::Lost);
    EXPECT_EQ(read.status[29], FrameStatus::Predicted);

    const std::string truthFile = writeTruth(dir);
    const std::string counts = "of the recording: 20 frames tracked, 10 predicted, 10 lost";
    EXPECT_THAT(evaluate({"rpe", truthFile, dir / "a.rawlog"}).out, HasSubstr(counts));
    EXPECT_THAT(evaluate({"ate", truthFile, dir / "a.rawlog"}).out, HasSubstr("30 of 30 poses"));
    const test::AppRun nees = evaluate({"nees", truthFile, dir / "a.rawlog", "--interval", "1f"});
    EXPECT_THAT(nees.out, HasSubstr(counts));
    EXPECT_THAT(
        nees.out, HasSubstr("increments of 1f: 39"));  // PDFs of lost frames are tested, too
    const auto json = nlohmann::json::parse(
        evaluate({"nees", truthFile, dir / "a.rawlog", "--interval", "1f", "--json", "-"}).out);
    EXPECT_EQ(json["coverage"][0]["frames"]["lost"], 10);
    for (const auto& [percent, code] : {std::pair("48", 0), std::pair("49", 1)})  // 19 of 39 steps
    {
        const test::AppRun gate = evaluate(
            {"nees", truthFile, dir / "a.rawlog", "--interval", "1f", "--min-coverage", percent});
        EXPECT_EQ(gate.code, code) << gate.err;
    }
}

/** As of pointplane-grabber's --live-output. */
TEST(MrptTrajectories, whereFramesWereSkippedCoverageIsNotOfTheRecording)
{
    test::TempDir dir;
    {
        RawlogWriter writer(dir / "a.rawlog");
        mrpt::obs::CObservationRobotPose pose;
        pose.sensorLabel = "RGBD_pose";
        pose.pose.cov.setIdentity();
        for (int k = 0; k < 40; ++k)
        {
            pose.timestamp = mrpt::Clock::fromDouble(1000 + 0.1 * k);
            writer.write(pose);
        }
        mrpt::obs::CObservationComment comment;
        comment.text = "pointplane-skipped label=RGBD";
        writer.write(comment);
        writer.close();
    }
    EXPECT_FALSE(readRawlogTrajectory(dir / "a.rawlog", "").marksFrames);
}

/** MRPT's default label is empty. */
TEST(MrptTrajectories, framesOfACameraWithoutALabelAreMarkedToo)
{
    test::TempDir dir;
    writeOdometry(dir / "a.rawlog", true, Eigen::Isometry3d::Identity(), "");
    const Trajectory read = readRawlogTrajectory(dir / "a.rawlog", "");
    EXPECT_TRUE(read.marksFrames);
    ASSERT_EQ(read.status.size(), 40u);
    EXPECT_EQ(read.status[10], FrameStatus::Lost);
    EXPECT_FALSE(read.sinceCovs.empty());
    EXPECT_EQ(evaluate({"ate", writeTruth(dir), dir / "a.rawlog", "--max-rmse", "1"}).code, 1);
}

TEST(MrptTrajectories, intervalsMayStandBeforeTheFiles)
{
    test::TempDir dir;
    writeOdometry(dir / "a.rawlog", true, Eigen::Isometry3d::Identity());
    const test::AppRun r =
        evaluate({"nees", "--interval", "1f,5f", writeTruth(dir), dir / "a.rawlog"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, HasSubstr("increments of 5f"));
}

TEST(MrptTrajectories, nothingIsTestedTwice)
{
    test::TempDir dir;
    writeOdometry(dir / "a.rawlog", true, Eigen::Isometry3d::Identity());
    const std::string truthFile = writeTruth(dir), run = dir / "a.rawlog";
    for (const char* intervals : {"1f,1f", "1f,1e0f", "1s,1.0s", "start,1f,start"})
    {
        const test::AppRun r = evaluate({"nees", truthFile, run, "--interval", intervals});
        EXPECT_EQ(r.code, 2) << intervals;
        EXPECT_THAT(r.err, HasSubstr(" is given more than once"));
    }
    const test::AppRun twice = evaluate({"nees", truthFile, run, truthFile, run});
    EXPECT_EQ(twice.code, 2);
    EXPECT_THAT(twice.err, HasSubstr("a.rawlog' is given more than once"));
    const std::string link = dir / "link.rawlog";
    std::filesystem::create_symlink("a.rawlog", link);
    for (const std::string& name : {dir / "./a.rawlog", link})
    {
        EXPECT_EQ(evaluate({"nees", truthFile, run, truthFile, name}).code, 2) << name;
    }
}

/** They would be a metre apart for another reason than their errors. */
TEST(MrptTrajectories, runsOfCameraAndRobotAreNotComparedInSilence)
{
    test::TempDir dir;
    writeOdometry(dir / "a.rawlog", true, Eigen::Isometry3d::Identity());
    const std::string truthFile = writeTruth(dir);
    std::string text = "# x right, y down\n";
    text += test::readBytes(truthFile);
    const std::string camera = writeFile(dir, "camera.txt", text);
    ASSERT_EQ(readTrajectoryText(camera).body, Body::Camera);
    const std::string hint = "hint: the poses of '" + camera + "' are of the camera";
    EXPECT_THAT(evaluate({"compare", truthFile, dir / "a.rawlog", camera}).err, HasSubstr(hint));
    EXPECT_THAT(
        evaluate({"compare", truthFile, camera, camera}).err, testing::Not(HasSubstr(hint)));
}

TEST(MrptTrajectories, covariancesShowWhichIsTheEstimate)
{
    test::TempDir dir;
    writeFormat2(dir / "a.rawlog", {"VO"});
    const std::string truthFile = writeTruth(dir);
    EXPECT_THAT(
        evaluate({"nees", dir / "a.rawlog", truthFile}).err,
        HasSubstr("a.rawlog' has covariances, and '" + truthFile + "' has not; is the ground"));
    EXPECT_THAT(
        evaluate({"nees", truthFile, dir / "a.rawlog"}).err,
        testing::Not(HasSubstr("given first")));
}

/** They are black: what was to be seen is in the frames around them. */
TEST(MrptTrajectories, noPictureOfALostFrameIsInAReport)
{
    test::TempDir dir;
    writeOdometry(dir / "a.rawlog", true, Eigen::Isometry3d::Identity());
    std::string table = "frame,stamp\n";
    for (int k = 0; k < 40; ++k)
    {
        table += std::to_string(k) + "," + std::to_string(100 + 0.1 * k) + "\n";
        if (k >= 15 && k <= 20)  // the last of them is not lost
        {
            writeFile(dir, "0000" + std::to_string(k) + ".jpg", "JPEG");
        }
    }
    const test::AppRun r = evaluate(
        {"rpe",
         writeTruth(dir),
         dir / "a.rawlog",
         "--report",
         dir / "r",
         "--diagnostics",
         writeFile(dir, "frames.csv", table),
         "--overlays",
         dir / ""});
    EXPECT_EQ(r.code, 0) << r.err;
    const std::string html = test::readBytes(dir / "r/index.html");
    EXPECT_THAT(html, HasSubstr("Frame 20 at 2.00 s: motion off by "));
    EXPECT_THAT(html, testing::Not(HasSubstr("Frame 1")));
}

/** A regular expression would take the stack. */
TEST(MrptTrajectories, labelsAndCommentsOfAnyLengthAndInLinesAreRead)
{
    test::TempDir dir;
    const std::string camera = "two\nlines" + std::string(1 << 20U, 'x');
    RawlogWriter writer(dir / "long.rawlog");
    for (std::size_t k = 0; k < 3; ++k)
    {
        writer.write(observationOf(k, camera + "_pose"));
        if (k > 0)
        {
            writer.write(observationOf(k, camera + "_since_1"));
        }
    }
    mrpt::obs::CObservationComment comment;
    comment.timestamp = fromSeconds(estimate().stamps[2]);
    for (const char* status : {" frame=2 found", " frame=2 lost: no\nimage"})
    {
        comment.text = "pointplane-status label=" + camera + status;
        writer.write(comment);
    }
    writer.close();
    const Trajectory read = readRawlogTrajectory(dir / "long.rawlog", "");
    ASSERT_EQ(read.status.size(), 3U);
    EXPECT_EQ(read.status[1], FrameStatus::Tracked);
    EXPECT_EQ(read.status[2], FrameStatus::Lost);
}

TEST(MrptTrajectories, neesHintsAtAnotherBody)
{
    test::TempDir dir;
    writeOdometry(dir / "a.rawlog", true, opticalInBody().inverse());
    // The same motion of a body with optical axes, told against a truth in MRPT's: --body-from-gt.
    std::ostringstream text;
    text.precision(15);
    for (std::size_t k = 0; k < truth().size(); ++k)
    {
        text << truth().stamps[k] << " " << truth().poses[k].translation().transpose() << " "
             << Eigen::Quaterniond(truth().poses[k].linear()).coeffs().transpose() << "\n";
    }
    const std::string truthFile = writeFile(dir, "truth.txt", text.str());
    const test::AppRun wrong = evaluate({"nees", truthFile, dir / "a.rawlog", "--interval", "1f"});
    EXPECT_THAT(wrong.err, HasSubstr("hint: with --body-from-gt optical the NEES"));
    const test::AppRun right = evaluate(
        {"nees", truthFile, dir / "a.rawlog", "--interval", "1f", "--body-from-gt", "optical"});
    EXPECT_THAT(right.err, testing::Not(HasSubstr("hint")));
}

/** Poses whose covariances do not grow by those of the increments: those cannot be told. */
TEST(MrptTrajectories, neesTestsThePosesWhereIncrementsAreNotTold)
{
    test::TempDir dir;
    {
        RawlogWriter writer(dir / "a.rawlog");
        for (std::size_t k = 0; k < estimate().size(); ++k)
        {
            auto observation = observationOf(k, "RGBD_pose");
            const double size = k == 0 ? 1e-12 : 1 + 0.5 * static_cast<double>(k % 2);
            observation.pose = toMrpt({estimate().poses[k], size * gaussianAt(39).cov});
            writer.write(observation);
        }
        writer.close();
    }
    const std::string truthFile = writeTruth(dir);
    const test::AppRun r = evaluate({"nees", truthFile, dir / "a.rawlog"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.err, HasSubstr("increments of 1f, 10f, 1s are not tested"));
    EXPECT_THAT(r.err, HasSubstr("pointplane-odometry --since 10"));
    EXPECT_THAT(r.out, HasSubstr("poses since the first one: 39, 1 without overlap"));
    // A gate that cannot be checked is not passed.
    const test::AppRun gate = evaluate({"nees", truthFile, dir / "a.rawlog", "--max-nees", "100"});
    EXPECT_EQ(gate.code, 2);
    EXPECT_THAT(gate.err, HasSubstr("cannot be checked"));
    EXPECT_EQ(evaluate({"ate", truthFile, dir / "a.rawlog", "--report", dir / "r"}).code, 0);
    EXPECT_THAT(test::readBytes(dir / "r/index.html"), HasSubstr("are not tested"));
}

/** It has poses alone: --since would not help. */
TEST(MrptTrajectories, ofASimplemapNeesAsksForARawlog)
{
    test::TempDir dir;
    mrpt::maps::CSimpleMap map;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const auto pdf = mrpt::poses::CPose3DPDFGaussian::Create(toMrpt(gaussianAt(k)));
        const auto frame = mrpt::obs::CSensoryFrame::Create(frameAt(k));
        map.insert(pdf, frame);
    }
    ASSERT_TRUE(map.saveToFile(dir / "a.simplemap"));
    const test::AppRun r =
        evaluate({"nees", writeTruth(dir), dir / "a.simplemap", "--interval", "1f"});
    EXPECT_THAT(
        r.err, HasSubstr("A .simplemap cannot: test the rawlog of pointplane-odometry --since"));
}

TEST(MrptTrajectories, neesSavesIncrements)
{
    test::TempDir dir;
    writeFormat2(dir / "a.rawlog", {"VO"});
    const std::string saved =
        evaluate({"nees", writeTruth(dir), dir / "a.rawlog", "--interval", "1f,5f", "--save", "-"})
            .out;
    EXPECT_THAT(saved, testing::StartsWith("estimate,interval,stamp_i,stamp_j,error_x_m,"));
    EXPECT_EQ(std::count(saved.begin(), saved.end(), '\n'), 1 + 39 + 35);
    EXPECT_THAT(saved, HasSubstr("a.rawlog,5f,100,100.5,"));
}
