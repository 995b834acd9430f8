// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/coverage.h>
#include <pointplane/evaluation/stamp_intervals.h>
#include <pointplane/evaluation/trajectory_text.h>

#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;
using testing::HasSubstr;

namespace
{
std::string messageOf(const std::string& path)
{
    try
    {
        (void)readTrajectoryText(path);
    }
    catch (const std::runtime_error& e)
    {
        return e.what();
    }
    return "";
}
}  // namespace

TEST(TrajectoryText, readsTumWithCommentsCommasTabsAndCarriageReturns)
{
    test::TempDir files;
    const Trajectory t = readTrajectoryText(writeFile(
        files,
        "t.txt",
        "# comment\n\n1.5 1 2 3 0 0 0 1.001\r\n0.5,\t4,5,6,  0,0,0.707,0.707\n"
        "\t\n"));
    ASSERT_EQ(t.size(), 2u);
    EXPECT_EQ(t.stamps[0], 0.5);                                                 // sorted
    EXPECT_TRUE(t.poses[0].linear().isApprox(so3Exp({0, 0, M_PI / 2}), 1e-12));  // normalised
    EXPECT_EQ(t.poses[1].translation(), Eigen::Vector3d(1, 2, 3));
    EXPECT_THAT(t.warnings, testing::ElementsAre(HasSubstr("1 step back in time")));
    EXPECT_TRUE(t.covs.empty());
}

/** EuRoC's quaternions begin with w, KITTI's lines with the first row of a matrix: read as TUM's,
 * they give a score, and a wrong one. */
TEST(TrajectoryText, otherFormatsAreNotTakenForTum)
{
    test::TempDir files;
    EXPECT_THAT(
        messageOf(writeFile(files, "n.txt", "1 0 0 0 0 0 0 1 9\n")),
        HasSubstr("n.txt:1: 9 columns; expected 8 (TUM: stamp tx ty tz qx qy qz qw) or"));
    EXPECT_THAT(
        messageOf(writeFile(files, "kitti.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n")),
        HasSubstr("kitti.txt:1: 12 columns, as KITTI's poses"));
    EXPECT_THAT(
        messageOf(writeFile(
            files, "euroc.csv", "#t\n1403636580838555648,4,-1,0,0,-0,-0,-0,1,0,0,0,0,0,0,0,0\n")),
        HasSubstr("euroc.csv:2: 17 columns, as EuRoC's ground truth"));
    EXPECT_THAT(
        messageOf(writeFile(files, "mixed.txt", "1 0 0 0 0 0 0\n2 0 0 0 0 0 0 1\n")),
        HasSubstr("mixed.txt:2: 8 columns"));
}

TEST(TrajectoryText, quaternionsOfAnotherLengthAreTold)
{
    test::TempDir files;
    const Trajectory t = readTrajectoryText(writeFile(
        files,
        "t.txt",
        "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 0.991\n3 0 0 0 0 0 0 0.98\n4 0 0 0 0 3 0 4\n"));
    EXPECT_EQ(t.size(), 4u);
    EXPECT_THAT(
        t.warnings,
        testing::ElementsAre(
            HasSubstr("t.txt: 2 lines with a quaternion whose norm is not 1, the first is "
                      "line 3; are columns 5 to 8 qx qy qz qw?")));
}

/** A disk that fails: its opening succeeds, reading it does not. */
TEST(TrajectoryText, anErrorWhileReadingIsNotTheEnd)
{
    EXPECT_THAT(messageOf("/proc/self/mem"), HasSubstr("cannot read /proc/self/mem: "));
}

TEST(TrajectoryText, readsBehindAByteOrderMark)
{
    test::TempDir files;
    const std::string mark = "\xEF\xBB\xBF";
    EXPECT_EQ(
        readTrajectoryText(writeFile(files, "t.txt", mark + "1.5 1 2 3 0 0 0 1\n")).size(), 1U);
    EXPECT_EQ(
        readTrajectoryText(writeFile(files, "c.txt", mark + "# c\n1.5 1 2 3 0 0 0 1\n")).size(),
        1U);
    EXPECT_THAT(messageOf(writeFile(files, "e.txt", "")), HasSubstr("(0 lines)"));
}

TEST(TrajectoryText, decimalCommasAreNotColumns)
{
    test::TempDir files;
    EXPECT_THAT(
        messageOf(writeFile(files, "t.txt", "1305031102,5 1 2 3 0 0 0 1\n")),
        HasSubstr("t.txt:1: '1305031102,5' has a decimal comma"));
    EXPECT_THAT(messageOf(writeFile(files, "m.txt", "7 1 2,5 3 0,3 0 0\n")), HasSubstr("'2,5'"));
    EXPECT_EQ(readTrajectoryText(writeFile(files, "c.txt", "1,1,2,3,0,0,0,1\n")).size(), 1U);
    EXPECT_EQ(
        readTrajectoryText(writeFile(files, "b.txt", "1, 1, 2 ,3 ,0 , 0, 0, 1\n")).size(), 1U);
}

TEST(TrajectoryText, readsMrptInterpolatorText)
{
    test::TempDir files;
    const Trajectory t = readTrajectoryText(
        writeFile(files, "t.txt", "% time x y z yaw pitch roll\n7 1 2 3 0.3 0 0\n"));
    ASSERT_EQ(t.size(), 1u);
    EXPECT_TRUE(t.poses[0].linear().isApprox(so3Exp({0, 0, 0.3}), 1e-12));
    const Trajectory r = readTrajectoryText(writeFile(files, "r.txt", "7 1 2 3 0.3 0.2 0.1\n"));
    const Eigen::Matrix3d expected =
        so3Exp({0, 0, 0.3}) * so3Exp({0, 0.2, 0}) * so3Exp({0.1, 0, 0});
    EXPECT_TRUE(r.poses[0].linear().isApprox(expected, 1e-12));
}

TEST(TrajectoryText, leavesOutNanZeroQuaternionsAndRepeatsButSaysSo)
{
    test::TempDir files;
    const Trajectory t = readTrajectoryText(writeFile(
        files,
        "t.txt",
        "1 0 0 0 0 0 0 1\n"
        "2 nan 0 0 0 0 0 1\n"
        "3 0 0 0 0 0 0 0\n"
        "4 7 0 0 0 0 0 1\n"
        "4 8 0 0 0 0 0 1\n"
        "5 0 0 0 0 0 1e200 1e200\n"));
    ASSERT_EQ(t.size(), 2u);
    EXPECT_EQ(t.poses[1].translation().x(), 8);  // the last one wins
    EXPECT_THAT(
        t.warnings,
        testing::ElementsAre(
            HasSubstr("1 pose with a repeated stamp"),
            HasSubstr("2 lines with NaN or infinity left out, the first is line 2"),
            HasSubstr("zero quaternion left out, the first is line 3")));
}

/** Left out without a trace, they would be bridged, and three lost frames of four not count. */
TEST(TrajectoryText, linesWithoutAPoseAreLostFrames)
{
    test::TempDir files;
    const Trajectory t = readTrajectoryText(writeFile(
        files,
        "t.txt",
        "# pointplane-status\n"
        "1 0 0 0 0 0 0 1\n"
        "2 nan 0 0 0 0 0 1\n"
        "3 0 0 0 0 0 0 0\n"
        "# pointplane-status 3.5 lost\n"
        "inf 0 0 0 0 0 0 1\n"
        "4 0 0 inf 0 0 0 1\n"
        "5 0 0 0 0 0 0 1\n"));
    EXPECT_THAT(t.lostStamps, testing::ElementsAre(2, 3, 3.5, 4));
    EXPECT_THAT(holesBefore(t), testing::ElementsAre(false, true));
    EXPECT_EQ(coverageOf(t, t, 0).share, 0);
}

/** Two recordings in one file, or frames in the wrong order. */
TEST(TrajectoryText, saysThatStampsGoBack)
{
    test::TempDir files;
    const Trajectory t = readTrajectoryText(writeFile(
        files,
        "t.txt",
        "1 0 0 0 0 0 0 1\n"
        "2 1 0 0 0 0 0 1\n"
        "1.5 7 0 0 0 0 0 1\n"
        "2.5 8 0 0 0 0 0 1\n"));
    EXPECT_EQ(t.stamps, (std::vector<double>{1, 1.5, 2, 2.5}));
    EXPECT_THAT(
        t.warnings,
        testing::ElementsAre(
            HasSubstr("1 step back in time, the first one from 2.000000 to 1.500000 s")));
}

TEST(TrajectoryText, hintsAtWhatIsOftenWrong)
{
    test::TempDir files;
    EXPECT_THAT(
        messageOf(writeFile(files, "h.csv", "stamp,x,y,z,qx,qy,qz,qw\n1,0,0,0,0,0,0,1\n")),
        HasSubstr("h.csv:1: 'stamp' is not a number; a header must begin with #"));
    const auto warningsOf = [&](const std::string& text)
    { return readTrajectoryText(writeFile(files, "w.txt", text)).warnings; };
    EXPECT_THAT(
        warningsOf("1000000000000000000 0 0 0 0 0 0 1\n1000000000050000000 0 0 0 0 0 0 1\n"),
        testing::ElementsAre(
            HasSubstr("w.txt: poses are 50000000 s apart; are stamps in nanoseconds? They must")));
    EXPECT_THAT(
        warningsOf("1 0 0 0 0 0 0\n2 0 0 0 -90 0 0\n3 0 0 0 180 0 0\n"),
        testing::ElementsAre(HasSubstr(
            "2 lines with an angle beyond 2 pi, the first is line 2; are angles in degrees?")));
    EXPECT_THAT(warningsOf("1 0 0 0 0 0 -6.28\n900 0 0 0 6.28 0 0\n"), testing::IsEmpty());
}

/** As of --graph, of graph-slam, and of g2o. */
TEST(TrajectoryText, aPoseGraphIsTold)
{
    test::TempDir files;
    for (const char* first : {"VERTEX3 0 0 0 0 0 0 0", "EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1"})
    {
        EXPECT_THAT(
            messageOf(writeFile(files, "vo.graph", std::string(first) + "\nFIX 0\n")),
            HasSubstr("vo.graph:1: is of a pose graph, whose nodes have no time stamps; give the "
                      "trajectory or the rawlog that was written with it"));
    }
}

/** Their bytes would do anything to a terminal. */
TEST(TrajectoryText, filesThatAreNoTextAreNotShown)
{
    test::TempDir files;
    for (const std::string& bytes :
         {std::string("\x89PNG\r\n\x1a\n"), std::string("1 0 0 \0", 7), std::string("\x1b[2J 1,5")})
    {
        const std::string path = writeFile(files, "b.bin", bytes);
        EXPECT_EQ(messageOf(path), path + ":1: is not text of numbers, as a trajectory is");
    }
}

TEST(TrajectoryText, namesFileAndLineOfMalformedInput)
{
    test::TempDir files;
    EXPECT_THAT(messageOf(files / "none.txt"), HasSubstr("none.txt"));
    EXPECT_THAT(messageOf(files / ""), HasSubstr("is a directory"));
    EXPECT_THAT(
        messageOf(writeFile(files, "a.txt", "1 0 0 0 0 0 0 1\n2 0 0 x1 0 0 0 1\n")),
        testing::EndsWith("a.txt:2: 'x1' is not a number"));
    EXPECT_THAT(
        messageOf(writeFile(files, "c.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0\n")),
        HasSubstr("c.txt:2: 7 columns"));
    EXPECT_THAT(messageOf(writeFile(files, "d.txt", "1 2 3\n")), HasSubstr("d.txt:1: 3 columns"));
    EXPECT_THAT(messageOf(writeFile(files, "e.txt", "# nothing\n")), HasSubstr("no usable pose"));
    EXPECT_THAT(
        messageOf(writeFile(files, "f.txt", "1 1e999 0 0 0 0 0 1\n")), HasSubstr("f.txt:1"));
}
